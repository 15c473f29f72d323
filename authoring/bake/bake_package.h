// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "authoring/bake/request/baked_maps.h"
#include "base/files.h"
#include "character/character.h"

namespace furrow::authoring {

// A finished bake as files for one folder: pictures, and a rig that names them.
struct BakedFiles {
  struct File {
    std::string name;  // relative to the folder: "squash_derivative.png"
    std::string bytes;
  };
  std::vector<File> files;
  wrinkle::Rig rig;                // the character's rig with the baked maps added
  std::vector<std::string> notes;  // requests that were not carried out, and why; one sentence each
};

struct PackageOptions {
  bool exr = false;    // write derivatives and heights as half floats instead of 16-bit PNG
  bool masks = false;  // let the rig's regions use the suggested masks
};

// Packs the baked maps. A map `squash` becomes the pictures squash_derivative, squash_height,
// squash_cavity and, on skin, squash_colour. The suggested masks become suggested_masks_skin_0,
// suggested_masks_cloth_0 and so on, with four regions per picture (red, green, blue, alpha in the
// order of the rig's regions).
//
// - With `masks`, the mask pictures are named masks_skin_0, ..., and the rig's regions use them. A
//   region that folds on both skin and cloth keeps its own mask, and a note says so.
// - A file never takes the name of a picture that the rig still uses or that the character
//   contains; it becomes squash_height_2 instead. Hand-edited masks therefore survive unless
//   `masks` replaces them.
// - In the new rig, baked maps have no normal map and the amplitude 1. Picture files that the rig
//   still uses are copied from `character.folder`; embedded pictures stay in the character.
//
// Errors: kInvalidArgument (slopes beyond the limit of a rig, or another fault that CheckRig()
// finds), and those of EncodePng(), EncodeExr() and ReadFile().
[[nodiscard]] Result<BakedFiles> PackageMaps(const character::Character& character,
                                             const BakedMaps& maps, const PackageOptions& options);

// The scale of a picture of integers: the larger of `least` and the largest magnitude in `values`,
// rounded up to a multiple of 0.05 of its power of ten (0.25, 0.3, ...).
[[nodiscard]] float RoundScale(const std::vector<float>& values, float least);

}  // namespace furrow::authoring

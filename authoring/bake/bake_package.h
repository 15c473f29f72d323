// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "authoring/bake/bake.h"
#include "base/files.h"

namespace furrow::character::bake {

// A finished bake as files that lie in one folder: pictures, and a rig that names them.
struct BakedFiles {
  struct File {
    std::string name;  // within the folder, "squash_derivative.png"
    std::string bytes;
  };
  std::vector<File> files;
  wrinkle::Rig rig;                // the character's own, with the baked maps in it
  std::vector<std::string> notes;  // what was not done as asked, and why; for people
};

struct PackageOptions {
  bool exr = false;    // derivatives and heights as half floats, not as 16-bit PNG
  bool masks = false;  // the rig's regions take the suggested masks instead of their own
};

// A map `squash` becomes squash_derivative, squash_height, squash_cavity and, on skin,
// squash_colour; the masks that its
// poses suggest, four regions a picture, suggested_masks_skin_0, suggested_masks_cloth_0 and so on
// (red, green, blue and alpha in the order of the rig's regions).
//
// - With `masks` they are called masks_skin_0, ..., and the rig's regions name them; a region that
//   folds on skin and on cloth keeps its own, with a note.
// - No file takes the name of a picture that the rig goes on naming, or that the character holds:
//   it becomes squash_height_2. So masks that were not asked for, and those of regions that are not
//   baked, stay as they were edited.
// - Baked maps lose their normal map and an amplitude that was made for it. Pictures of files that
//   the rig goes on naming are copied from `character.folder`; those inside the character stay.
//
// Errors: kInvalidArgument (slopes beyond what a rig may state, another fault that CheckRig()
// finds), EncodePng()'s and EncodeExr()'s, and ReadFile()'s.
[[nodiscard]] Result<BakedFiles> PackageMaps(const Character& character, const BakedMaps& maps,
                                             const PackageOptions& options);

// The next round number at which all of `values` fit a picture of integers, at least `least`.
[[nodiscard]] float RoundScale(const std::vector<float>& values, float least);

}  // namespace furrow::character::bake

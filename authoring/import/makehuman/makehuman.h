// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "base/status.h"
#include "character/character.h"
#include "wrinkle/skeleton/pose_frame.h"

namespace furrow::authoring {

struct ImportOptions {
  // The garment: a folder of <folder>/clothes. Empty: the first by name, or none if there is none.
  std::string clothes;
  // The wrinkle rig to embed. Empty: makehuman.json of the data folder (see data_dir.h).
  std::filesystem::path rig;
  // Reads the frames of <folder>/poseunits that the rig names (motion::CachedPoseSource).
  wrinkle::PoseSource poses;
  int texture_size = 1024;  // texels, square; [64, 4096]; wrinkle maps: the power of two below
  std::function<bool(float)> progress;  // of the bake, as Bake() takes it; may be empty
};

// What came in, for people: printed by `furrow character import`.
struct ImportReport {
  int joints = 0;
  int vertices = 0;  // as drawn, after splitting at UV seams
  int triangles = 0;
  int hidden_faces = 0;         // of the body, under the clothes
  int unweighted_vertices = 0;  // drawn or not; they follow the root
  int truncated_vertices = 0;   // had more than four joints
  std::vector<std::string> warnings;
};

// Makes a character of face and clothed body out of MakeHuman's data folder (docs/HOWTO-import.md):
//   3dobjs/base.obj, rigs/default.mhskel, rigs/default_weights.mhw, poseunits/face-poseunits.bvh,
//   clothes/<name>/<name>.mhclo and the .obj that it names.
//
// - Decimetres become metres; the lowest point of the body stands on y = 0.
// - Joints keep MakeHuman's names, with axes parallel to the model's in the rest pose.
// - Colours, pores and masks are painted (skin_paint.h, prop_paint.h); wrinkle maps are baked from
//   the rig's poses and the folds of the face (face_folds.h).
// - The rig is bound to the skeleton once, so that a rig
//   and a folder that do not fit are found here.
//
// Errors name the file and line or field: kNotFound (a file, a joint), kParse, kSchema, kNonFinite,
// kInvalidArgument (an index out of range, an option), kLimit, kIo.
[[nodiscard]] Result<character::Character> ImportMakeHuman(const std::filesystem::path& folder,
                                                           const ImportOptions& options = {},
                                                           ImportReport* report = nullptr);

}  // namespace furrow::authoring

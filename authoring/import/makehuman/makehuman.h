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

// The options of ImportMakeHuman().
struct ImportOptions {
  // The garment: a folder in <folder>/clothes. Empty: the first by name, if there is one. Not used
  // with a save, which names its garments itself.
  std::string clothes;
  // A .mhm file: the person to make. Empty: the base mesh without a person's shape.
  std::filesystem::path save;
  // Further data folders, in which the parts and materials of the save are also looked for, such as
  // that of MakeHuman's user.
  std::vector<std::filesystem::path> asset_folders;
  // The wrinkle rig to embed. Empty: makehuman.json of Furrow's data folder.
  std::filesystem::path rig;
  // Reads the frames of <folder>/poseunits that the rig names, for example
  // motion::CachedPoseSource.
  wrinkle::PoseSource poses;
  // Width and height of pictures, texels, [64, 4096]. Wrinkle maps use the largest power of two
  // that is not larger.
  int texture_size = 1024;
  // Receives the completed fraction of the bake, [0, 1], on the calling thread; returning false
  // cancels. Optional.
  std::function<bool(float)> progress;
};

// The result in numbers, printed by `furrow character import`.
struct ImportReport {
  int joints = 0;
  int vertices = 0;  // after splitting at UV seams
  int triangles = 0;
  int hidden_faces = 0;            // faces of the body under the clothes
  int unweighted_vertices = 0;     // vertices without weights, drawn or not; they follow the root
  int truncated_vertices = 0;      // vertices with more than four joints; the weakest were dropped
  std::vector<std::string> notes;  // what was made of a save
  std::vector<std::string> warnings;
};

// Makes a character with face and clothed body from MakeHuman's data folder (docs/HOWTO-import.md).
// It reads these files:
//   3dobjs/base.obj, rigs/default.mhskel, rigs/default_weights.mhw, poseunits/face-poseunits.bvh,
//   clothes/<name>/<name>.mhclo and the .obj that it names.
//
// - Decimetres become metres. The lowest point of the body is at y = 0.
// - Joints keep MakeHuman's names. Their axes are parallel to the model's in the rest pose.
// - Colours, pores and masks are painted. Wrinkle maps are baked from the rig's poses and from
//   strokes at the usual folds of a face.
// - The rig is bound to the skeleton once, which detects a rig that does not fit the folder.
//
// With a save, the folder's targets shape the base mesh first, and joints, clothes and all else are
// fitted to that shape. The save's parts and materials replace what is painted, where the folder
// has them with their pictures. Everything that it lacks is a warning.
//
// `report` (may be null) is set on success only. Errors name the file and the line or field:
// kNotFound (a file, a joint), kParse, kSchema, kNonFinite, kInvalidArgument (an index or option
// out of range), kLimit, kIo, and those of ParseMhm(), ShapePerson() and Bake().
[[nodiscard]] Result<character::Character> ImportMakeHuman(const std::filesystem::path& folder,
                                                           const ImportOptions& options = {},
                                                           ImportReport* report = nullptr);

}  // namespace furrow::authoring

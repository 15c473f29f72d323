// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"

namespace furrow::authoring {

// A file of another format, as glTF.
struct ForeignModel {
  std::string glb;                   // version 2.0: metres, +Y up as the file says so
  std::vector<std::string> remarks;  // what was converted, and what is not carried
};

// Whether assimp reads files of this extension (".fbx"; case does not matter).
[[nodiscard]] bool AssimpReads(std::string_view extension);

// Reads a skinned model (FBX, Collada, and whatever else assimp knows) and writes it as glTF, so
// that one reader checks everything that comes from outside (character.h).
//
// - `extension` tells the format (".fbx"). Nothing but `bytes` is opened: pictures beside the file
//   are named in the glTF by their file names alone.
// - Carried: nodes, skinned and plain meshes with normals and the first UVs, up to 16 influences a
//   vertex, materials with colour, roughness, base-colour and normal pictures, embedded pictures.
//   Blend shapes, lights, cameras and animations are not; remarks say which there were.
// - Vertices are brought into the rest pose and inverse bind matrices are the inverses of the rest
//   pose, so meshes that were bound in different poses fit together.
// - It runs confined (confined.h). Errors: kParse (damaged, another format), kUnsupported (no
//   mesh), kLimit (size, memory, time, joints, vertices).
[[nodiscard]] Result<ForeignModel> ReadWithAssimp(std::string_view bytes,
                                                  const std::string& extension);

}  // namespace furrow::authoring

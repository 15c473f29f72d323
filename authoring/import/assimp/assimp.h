// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"

namespace furrow::authoring {

// A model in another format, converted to glTF.
struct ForeignModel {
  std::string glb;  // glTF 2.0; metres and +Y up, as far as the file states its space
  std::vector<std::string> remarks;  // what was converted, and what was lost
};

// Whether assimp reads files with this extension (".fbx"). Case is ignored.
[[nodiscard]] bool AssimpReads(std::string_view extension);

// Reads a skinned model (FBX, Collada or another format of assimp) and converts it to glTF. One
// reader then checks all foreign data (character.h).
//
// - `extension` selects the format (".fbx"). Only `bytes` are read. The glTF names pictures beside
//   the file by their file names.
// - Converted: nodes; skinned and plain meshes with normals and the first UVs; up to 16 influences
//   per vertex; materials with colour, roughness, base-colour and normal pictures; embedded
//   pictures. Remarks name what is lost: blend shapes, lights, cameras, animations.
// - Vertices are moved to the rest pose, and inverse bind matrices are the inverses of the rest
//   pose. Meshes that were bound in different poses therefore fit together.
// - assimp runs in a child process with limits (child_process.h).
// Errors: kParse (damaged, or another format), kUnsupported (no mesh), kLimit (size, memory, time,
// joints, vertices).
[[nodiscard]] Result<ForeignModel> ReadWithAssimp(std::string_view bytes,
                                                  const std::string& extension);

}  // namespace furrow::authoring

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"

namespace furrow::authoring {

// A model of another format, converted to glTF.
struct ForeignModel {
  std::string glb;  // binary glTF 2.0; in metres and +Y up if the file states its unit and axes
  std::vector<std::string> remarks;  // what was converted, and what was lost
};

// Reads a skinned model (FBX, Collada or another format of assimp) and converts it to glTF, which
// the glTF reader then checks like any other file.
//
// - `extension` selects the format (".fbx"). No other files are read. The glTF refers to pictures
//   beside the model by their file names.
// - Converted: nodes; skinned and plain meshes with normals and the first UVs; up to 16 influences
//   per vertex; materials with colour, roughness, base-colour and normal pictures; embedded
//   pictures. Remarks name what is lost: blend shapes, lights, cameras, animations.
// - Vertices are moved to the rest pose, and inverse bind matrices are the inverses of the rest
//   pose. Meshes that were bound in different poses therefore fit together.
// - assimp runs in the helper program furrow-assimp with limits on memory and time, so a crash in
//   assimp is an error.
//
// Errors: kParse (damaged, or another format), kUnsupported (no mesh, or an extension that assimp
// does not know), kLimit (size, memory, time, joints, vertices), kNotFound (no furrow-assimp).
[[nodiscard]] Result<ForeignModel> ReadWithAssimp(std::string_view bytes,
                                                  const std::string& extension);

}  // namespace furrow::authoring

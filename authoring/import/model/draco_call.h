// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/document/draco_mesh.h"

namespace furrow::authoring {

// Decodes the Draco meshes of a glTF file in the helper program furrow-draco, with limits on memory
// and time. Errors: kParse (damaged), kLimit (memory, time, vertices), kUnsupported (a type that
// glTF does not have), kNotFound (no furrow-draco).
[[nodiscard]] gltf::DracoDecoder DracoInHelper();

}  // namespace furrow::authoring

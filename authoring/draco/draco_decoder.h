// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "base/status.h"
#include "gltf/document/draco_mesh.h"

namespace furrow::authoring {

// Decodes a mesh by libdraco, which trusts its input: call it only in the helper program, whose
// memory and time are limited. Errors: kParse (damaged, or no mesh), kUnsupported (an attribute of
// a type that glTF does not have), kLimit (more vertices or indices than gltf/limits.h).
[[nodiscard]] Result<gltf::DracoMesh> DecodeDraco(std::string_view compressed);

}  // namespace furrow::authoring

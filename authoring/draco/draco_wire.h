// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"
#include "gltf/document/draco_mesh.h"

// What furrow-draco reads and writes. Both ends belong to one build, so there is no version and no
// fixed byte order.
namespace furrow::authoring {

// Compressed meshes as the input of the helper.
[[nodiscard]] std::string EncodeDracoCall(
    std::span<const std::span<const std::uint8_t>> compressed);
// The inverse. The result refers to `bytes`. Errors: kParse.
[[nodiscard]] Result<std::vector<std::string_view>> DecodeDracoCall(std::string_view bytes);

// Decoded meshes as the helper's payload.
[[nodiscard]] std::string EncodeDracoMeshes(std::span<const gltf::DracoMesh> meshes);
// The inverse. A hostile file may have taken over the helper: every size, type and index is
// checked. Errors: kParse.
[[nodiscard]] Result<std::vector<gltf::DracoMesh>> DecodeDracoMeshes(std::string_view bytes);

// Bytes per component of an accessor's componentType, 0 for types that glTF does not have.
[[nodiscard]] std::size_t ComponentBytes(int component_type);

}  // namespace furrow::authoring

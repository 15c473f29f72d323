// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "base/status.h"

namespace furrow::gltf {

// One attribute of a decoded mesh.
struct DracoAttribute {
  std::uint32_t id = 0;              // the unique id by which glTF refers to it
  int component_type = 0;            // as in an accessor: 5120 to 5126 without 5124
  int components = 0;                // 1 to 4
  std::vector<std::uint8_t> values;  // one element per point, tightly packed
};

// A mesh that KHR_draco_mesh_compression has compressed.
struct DracoMesh {
  std::size_t num_points = 0;
  std::vector<std::uint32_t> indices;  // triangles; each below num_points
  std::vector<DracoAttribute> attributes;
};

// Decodes the compressed meshes of one file. gltf/ has no decoder of its own: libdraco trusts its
// input, so it must not run in a process that others depend on.
using DracoDecoder = std::function<Result<std::vector<DracoMesh>>(
    std::span<const std::span<const std::uint8_t>> meshes)>;

}  // namespace furrow::gltf

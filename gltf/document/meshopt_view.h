// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/status.h"

namespace furrow::gltf {

// A buffer view as EXT_meshopt_compression states it.
struct MeshoptView {
  std::span<const std::uint8_t> bytes;  // compressed
  std::uint64_t count = 0;              // elements
  std::uint64_t stride = 0;             // bytes per element
  std::string mode;                     // "ATTRIBUTES", "TRIANGLES", "INDICES"
  std::string filter;                   // "", "NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"
};

// Decodes a view: count * stride bytes. The format cannot expand bytes more than 64 times, so a
// count beyond that is rejected before anything is allocated.
//
// Errors: kSchema (an unknown mode or filter, a stride that does not fit, a count that is too
// large), kParse (damaged data), kUnsupported (a newer version of the format). `where` is `field`.
[[nodiscard]] Result<std::vector<std::uint8_t>> DecodeMeshopt(const MeshoptView& view,
                                                              const std::string& field);

}  // namespace furrow::gltf

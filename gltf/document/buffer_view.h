// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace furrow::gltf {

struct BufferView {
  std::span<const std::uint8_t> bytes;
  std::size_t stride = 0;  // 0: elements are tightly packed
};

// The buffer views of a document, and the bytes of those that the file does not hold as they are.
struct BufferViews {
  std::vector<BufferView> views;
  std::vector<std::vector<std::uint8_t>> owned_buffers;  // of data URIs, files, meshopt, Draco
};

}  // namespace furrow::gltf

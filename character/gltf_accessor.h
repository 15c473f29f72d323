// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "base/status.h"

namespace tinygltf {
class Model;
}

namespace furrow::character {

// A glTF accessor whose every element has been found to lie inside its buffer.
class GltfAccessor {
 public:
  // `components`: how many are due (3 for a VEC3); `where` names the field in errors. Errors:
  // kSchema (no such accessor, other type), kParse (past its buffer view), kUnsupported (sparse).
  [[nodiscard]] static Result<GltfAccessor> Create(const tinygltf::Model& model, int accessor,
                                                   int components, const std::string& where);

  [[nodiscard]] std::size_t size() const { return count_; }
  // As a number; normalised integers as fractions of their range.
  [[nodiscard]] float Float(std::size_t element, int component) const;
  // Of an accessor of unsigned integers.
  [[nodiscard]] std::uint32_t Unsigned(std::size_t element, int component = 0) const;
  [[nodiscard]] bool is_unsigned() const;

 private:
  template <class T>
  [[nodiscard]] T Load(std::size_t element, int component) const;

  const unsigned char* data_ = nullptr;
  std::size_t count_ = 0;
  std::size_t stride_ = 0;
  int component_type_ = 0;
  bool normalized_ = false;
};

}  // namespace furrow::character

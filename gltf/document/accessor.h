// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/status.h"
#include "gltf/document/document.h"

namespace furrow::gltf {

// The element types that glTF calls SCALAR, VEC2 and so on. The values are tinygltf's.
enum class ElementType : std::uint8_t { kScalar = 65, kVec2 = 2, kVec3 = 3, kVec4 = 4, kMat4 = 36 };
// Numbers per element: 1, 2, 3, 4 or 16.
[[nodiscard]] int ComponentsOf(ElementType type);

// A typed view of a buffer. Create() checks that every element lies inside its buffer view.
// The document must outlive it.
//
// Sparse accessors replace some elements (glTF 2.0, section 3.6.2.3). Nothing is copied: each read
// looks the element up. An accessor without a buffer view holds zeros.
class Accessor {
 public:
  // `where` names the field that refers to the accessor, for errors.
  //
  // Errors: kSchema (no such accessor or buffer view, another element type, doubles, empty, out of
  // range, sparse indices that do not ascend), kLimit (kMaxAccessorNumbers).
  [[nodiscard]] static Result<Accessor> Create(const Document& document, int accessor,
                                               ElementType type, const std::string& where);

  [[nodiscard]] std::size_t size() const { return count_; }
  // The elements that may differ from 0, ascending: Candidate(0) to Candidate(num_candidates() -
  // 1). All elements, unless the accessor is sparse and has no buffer view.
  [[nodiscard]] std::size_t num_candidates() const { return data_ ? count_ : sparse_.count; }
  [[nodiscard]] std::size_t Candidate(std::size_t i) const { return data_ ? i : sparse_.Index(i); }
  // True for unsigned bytes, shorts and ints that are not normalised or read as if not.
  [[nodiscard]] bool is_unsigned() const;
  // True for floats and for normalised integers.
  [[nodiscard]] bool is_real() const;

  // One component as a number. Normalised integers become [0, 1] or [-1, 1] (glTF 2.0, section
  // 3.11); other integers keep their value. Not checked for NaN.
  [[nodiscard]] float Float(std::size_t element, int component) const;
  // One component of an accessor with is_unsigned().
  [[nodiscard]] std::uint32_t Unsigned(std::size_t element, int component = 0) const;

 private:
  // The elements that a sparse accessor replaces, both lists tightly packed.
  struct Sparse {
    [[nodiscard]] std::size_t Index(std::size_t i) const;
    // The place of an element in `values`, or nullptr if the element is not replaced.
    [[nodiscard]] const std::uint8_t* Find(std::size_t element, std::size_t element_bytes) const;

    std::size_t count = 0;
    const std::uint8_t* indices = nullptr;  // ascending
    std::size_t index_bytes = 0;            // 1, 2 or 4
    const std::uint8_t* values = nullptr;
  };

  static Status ReadSparse(const Document& document, int accessor, const std::string& where,
                           Accessor* to);
  template <class T>
  [[nodiscard]] T Load(std::size_t element, int component) const;

  const std::uint8_t* data_ = nullptr;  // nullptr: zeros
  std::size_t element_bytes_ = 0;
  Sparse sparse_;
  std::size_t count_ = 0;
  std::size_t stride_ = 0;
  int component_type_ = 0;
  bool normalized_ = false;
};

// All numbers of an accessor of floats or normalised integers, element by element. Subtracts their
// count from `budget` first, so that many accessors of one file cannot exhaust memory.
//
// Errors: Create()'s, kSchema (plain integers), kLimit (the budget), kNonFinite.
[[nodiscard]] Result<std::vector<float>> ReadFloats(const Document& document, int accessor,
                                                    ElementType type, const std::string& where,
                                                    std::size_t* budget);

}  // namespace furrow::gltf

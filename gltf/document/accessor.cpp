// SPDX-License-Identifier: Apache-2.0
#include "gltf/document/accessor.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <tiny_gltf.h>

#include "gltf/limits.h"

namespace furrow::gltf {

// ElementType is cast to tinygltf's constants.
static_assert(static_cast<int>(ElementType::kScalar) == TINYGLTF_TYPE_SCALAR);
static_assert(static_cast<int>(ElementType::kVec2) == TINYGLTF_TYPE_VEC2);
static_assert(static_cast<int>(ElementType::kVec3) == TINYGLTF_TYPE_VEC3);
static_assert(static_cast<int>(ElementType::kVec4) == TINYGLTF_TYPE_VEC4);
static_assert(static_cast<int>(ElementType::kMat4) == TINYGLTF_TYPE_MAT4);

int ComponentsOf(ElementType type) {
  return tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type));
}

namespace {

// `count` tightly packed values of a buffer view. nullptr if the view does not exist or is shorter.
const std::uint8_t* PackedValues(const Document& document, int view, int offset, std::size_t count,
                                 std::size_t value_bytes) {
  if (view < 0 || static_cast<std::size_t>(view) >= document.views().size()) return nullptr;
  const std::span<const std::uint8_t> bytes =
      document.views()[static_cast<std::size_t>(view)].bytes;
  if (offset < 0 || static_cast<std::size_t>(offset) > bytes.size()) return nullptr;
  if (count > (bytes.size() - static_cast<std::size_t>(offset)) / value_bytes) return nullptr;
  return bytes.data() + offset;
}

std::size_t IndexBytes(int component_type) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return 1;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return 4;
    default: return 0;
  }
}

}  // namespace

std::size_t Accessor::Sparse::Index(std::size_t i) const {
  const std::uint8_t* bytes = indices + i * index_bytes;
  std::size_t index = 0;
  for (std::size_t k = 0; k < index_bytes; ++k) index |= std::size_t{bytes[k]} << (8 * k);
  return index;
}

const std::uint8_t* Accessor::Sparse::Find(std::size_t element, std::size_t element_bytes) const {
  std::size_t low = 0;
  for (std::size_t high = count; low < high;) {
    const std::size_t middle = (low + high) / 2;
    (Index(middle) < element ? low : high) = Index(middle) < element ? middle + 1 : middle;
  }
  return low < count && Index(low) == element ? values + low * element_bytes : nullptr;
}

// Needs count_ and element_bytes_. The order of the indices is checked because Find() relies on it.
Status Accessor::ReadSparse(const Document& document, int accessor, const std::string& where,
                            Accessor* to) {
  const auto schema_error = [&](const char* what) {
    return Status(StatusCode::kSchema, what, where);
  };
  const auto& from = document.model().accessors[static_cast<std::size_t>(accessor)].sparse;
  if (from.count < 0 || static_cast<std::size_t>(from.count) > to->count_) {
    return schema_error("the sparse accessor replaces more elements than it has");
  }
  Sparse sparse;
  sparse.count = static_cast<std::size_t>(from.count);
  sparse.index_bytes = IndexBytes(from.indices.componentType);
  if (sparse.index_bytes == 0) {
    return schema_error("the sparse indices must be unsigned bytes, shorts or ints");
  }
  sparse.indices = PackedValues(document, from.indices.bufferView, from.indices.byteOffset,
                                sparse.count, sparse.index_bytes);
  sparse.values = PackedValues(document, from.values.bufferView, from.values.byteOffset,
                               sparse.count, to->element_bytes_);
  if (sparse.indices == nullptr || sparse.values == nullptr) {
    return schema_error("the sparse part ends after the end of its buffer view");
  }
  for (std::size_t i = 0; i < sparse.count; ++i) {
    if (sparse.Index(i) >= to->count_ || (i > 0 && sparse.Index(i) <= sparse.Index(i - 1))) {
      return schema_error("the sparse indices must ascend and lie below the accessor's count");
    }
  }
  to->sparse_ = sparse;
  return {};
}

// Checks every index, count and offset once, so that the loads below need no checks.
Result<Accessor> Accessor::Create(const Document& document, int accessor, ElementType type,
                                  const std::string& where) {
  const auto schema_error = [&](std::string what) {
    return Status(StatusCode::kSchema, std::move(what), where);
  };
  const tinygltf::Model& model = document.model();
  if (accessor < 0 || static_cast<std::size_t>(accessor) >= model.accessors.size()) {
    return schema_error("accessor " + std::to_string(accessor) + " does not exist");
  }
  const tinygltf::Accessor& from = model.accessors[static_cast<std::size_t>(accessor)];
  const bool has_view = from.bufferView != -1;
  if (has_view && static_cast<std::size_t>(from.bufferView) >= document.views().size()) {
    return schema_error("the accessor's buffer view does not exist");
  }
  const int component_bytes =
      tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(from.componentType));
  if (from.type != static_cast<int>(type) || component_bytes <= 0 ||
      from.componentType == TINYGLTF_COMPONENT_TYPE_DOUBLE) {
    return schema_error("the accessor has the wrong type, expected elements of " +
                        std::to_string(ComponentsOf(type)) + " numbers");
  }
  const auto components = static_cast<std::size_t>(ComponentsOf(type));
  if (from.count == 0) return schema_error("the accessor is empty");
  if (from.count > kMaxAccessorNumbers / components) {
    return Status(StatusCode::kLimit, "the accessor has too many elements", where);
  }
  Accessor to;
  to.count_ = from.count;
  to.component_type_ = from.componentType;
  to.normalized_ = from.normalized;
  to.element_bytes_ = components * static_cast<std::size_t>(component_bytes);
  if (has_view) {
    const BufferView& view = document.views()[static_cast<std::size_t>(from.bufferView)];
    to.stride_ = view.stride != 0 ? view.stride : to.element_bytes_;
    if (to.stride_ < to.element_bytes_) {
      return schema_error("the buffer view's byteStride is too small");
    }
    // Neither factor exceeds 2^27, so the product cannot overflow.
    const std::size_t needed = (from.count - 1) * to.stride_ + to.element_bytes_;
    if (from.byteOffset > view.bytes.size() || needed > view.bytes.size() - from.byteOffset) {
      return schema_error("the accessor ends after the end of its buffer view");
    }
    to.data_ = view.bytes.data() + from.byteOffset;
  }
  if (from.sparse.isSparse) {
    FURROW_RETURN_IF_ERROR(ReadSparse(document, accessor, where, &to));
  }
  return to;
}

template <class T>
T Accessor::Load(std::size_t element, int component) const {
  const std::uint8_t* from = sparse_.Find(element, element_bytes_);
  if (from == nullptr && data_ != nullptr) from = data_ + element * stride_;
  T value{};  // copied: buffers need not be aligned
  if (from != nullptr) {
    std::memcpy(&value, from + static_cast<std::size_t>(component) * sizeof(T), sizeof(T));
  }
  return value;
}

float Accessor::Float(std::size_t element, int component) const {
  // glTF 2.0, section 3.11: c / 127 and so on. The lowest signed value would fall below -1, hence
  // max().
  const auto scaled = [&](auto value, float range) {
    const auto number = static_cast<float>(value);
    return normalized_ ? std::max(number / range, -1.0f) : number;
  };
  switch (component_type_) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: return scaled(Load<std::int8_t>(element, component), 127.0f);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return scaled(Load<std::uint8_t>(element, component), 255.0f);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return scaled(Load<std::int16_t>(element, component), 32767.0f);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return scaled(Load<std::uint16_t>(element, component), 65535.0f);
    case TINYGLTF_COMPONENT_TYPE_INT:
      return static_cast<float>(Load<std::int32_t>(element, component));
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return static_cast<float>(Load<std::uint32_t>(element, component));
    default: return Load<float>(element, component);
  }
}

bool Accessor::is_unsigned() const {
  return component_type_ == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
         component_type_ == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
         component_type_ == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

bool Accessor::is_real() const {
  switch (component_type_) {
    case TINYGLTF_COMPONENT_TYPE_FLOAT: return true;
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return normalized_;
    default: return false;
  }
}

std::uint32_t Accessor::Unsigned(std::size_t element, int component) const {
  switch (component_type_) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return Load<std::uint8_t>(element, component);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return Load<std::uint16_t>(element, component);
    default: return Load<std::uint32_t>(element, component);
  }
}

Result<std::vector<float>> ReadFloats(const Document& document, int accessor, ElementType type,
                                      const std::string& where, std::size_t* budget) {
  const Result<Accessor> from = Accessor::Create(document, accessor, type, where);
  FURROW_RETURN_IF_ERROR(from);
  if (!from->is_real()) {
    return Status(StatusCode::kSchema, "expected floats or normalised integers", where);
  }
  const int components = ComponentsOf(type);
  const std::size_t count = from->size() * static_cast<std::size_t>(components);
  // Many accessors may share one buffer view, so the size of the file does not bound the sum.
  if (count > *budget)
    return Status(StatusCode::kLimit, "the file has too many accessor values", where);
  *budget -= count;
  std::vector<float> values;
  values.reserve(count);
  for (std::size_t element = 0; element < from->size(); ++element) {
    for (int component = 0; component < components; ++component) {
      values.push_back(from->Float(element, component));
      if (!std::isfinite(values.back())) {
        return Status(StatusCode::kNonFinite,
                      "element " + std::to_string(element) + " is not finite", where);
      }
    }
  }
  return values;
}

}  // namespace furrow::gltf

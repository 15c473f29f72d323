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
  if (from.sparse.isSparse) {
    return Status(StatusCode::kUnsupported, "sparse accessors are not supported", where,
                  "export without sparse accessors");
  }
  if (from.bufferView < 0 || static_cast<std::size_t>(from.bufferView) >= document.views().size()) {
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
  const BufferView& view = document.views()[static_cast<std::size_t>(from.bufferView)];
  const std::size_t element = components * static_cast<std::size_t>(component_bytes);
  const std::size_t stride = view.stride != 0 ? view.stride : element;
  if (stride < element) return schema_error("the buffer view's byteStride is too small");
  // Neither factor exceeds 2^27, so the product cannot overflow.
  const std::size_t needed = (from.count - 1) * stride + element;
  if (from.byteOffset > view.bytes.size() || needed > view.bytes.size() - from.byteOffset) {
    return schema_error("the accessor ends after the end of its buffer view");
  }
  Accessor to;
  to.data_ = view.bytes.data() + from.byteOffset;
  to.count_ = from.count;
  to.stride_ = stride;
  to.component_type_ = from.componentType;
  to.normalized_ = from.normalized;
  return to;
}

template <class T>
T Accessor::Load(std::size_t element, int component) const {
  T value;  // copied: buffers need not be aligned
  std::memcpy(&value, data_ + element * stride_ + static_cast<std::size_t>(component) * sizeof(T),
              sizeof(T));
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

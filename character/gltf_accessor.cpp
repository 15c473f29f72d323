// SPDX-License-Identifier: Apache-2.0
#include "character/gltf_accessor.h"

#include <algorithm>
#include <cstring>

#include <tiny_gltf.h>

namespace furrow::character {

Result<GltfAccessor> GltfAccessor::Create(const tinygltf::Model& model, int accessor,
                                          int components, const std::string& where) {
  if (accessor < 0 || accessor >= static_cast<int>(model.accessors.size())) {
    return Status(StatusCode::kSchema, "there is no accessor " + std::to_string(accessor), where);
  }
  const tinygltf::Accessor& from = model.accessors[accessor];
  if (from.sparse.isSparse || from.bufferView < 0) {
    return Status(StatusCode::kUnsupported, "sparse accessors are not read", where);
  }
  if (from.bufferView >= static_cast<int>(model.bufferViews.size())) {
    return Status(StatusCode::kSchema, "the accessor has no buffer view", where);
  }
  const int has = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(from.type));
  const int component_bytes =
      tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(from.componentType));
  if (has != components || component_bytes <= 0 ||
      from.componentType == TINYGLTF_COMPONENT_TYPE_DOUBLE) {
    return Status(StatusCode::kSchema,
                  "the accessor has elements of " + std::to_string(has) + " numbers, " +
                      std::to_string(components) + " are due",
                  where);
  }
  const tinygltf::BufferView& view = model.bufferViews[from.bufferView];
  const auto& bytes = model.buffers[view.buffer].data;
  const std::size_t element = static_cast<std::size_t>(components) * component_bytes;
  const int stride = from.ByteStride(view);
  const bool view_fits =
      view.byteOffset <= bytes.size() && view.byteLength <= bytes.size() - view.byteOffset;
  const bool stride_fits = stride >= static_cast<int>(element) && stride <= 255;
  // Matrices are longer than a stated stride may be, and stand close.
  const bool close = view.byteStride == 0 && stride == static_cast<int>(element);
  const bool fits = view_fits && (stride_fits || close) && from.count > 0 &&
                    from.byteOffset <= view.byteLength &&
                    element <= view.byteLength - from.byteOffset &&
                    from.count - 1 <= (view.byteLength - from.byteOffset - element) /
                                          static_cast<std::size_t>(std::max(stride, 1));
  if (!fits) {
    return Status(StatusCode::kParse, "the accessor ends past its buffer view, or is empty", where);
  }
  GltfAccessor to;
  to.data_ = bytes.data() + view.byteOffset + from.byteOffset;
  to.count_ = from.count;
  to.stride_ = static_cast<std::size_t>(stride);
  to.component_type_ = from.componentType;
  to.normalized_ = from.normalized;
  return to;
}

template <class T>
T GltfAccessor::Load(std::size_t element, int component) const {
  T value;
  std::memcpy(&value, data_ + element * stride_ + static_cast<std::size_t>(component) * sizeof(T),
              sizeof(T));
  return value;
}

float GltfAccessor::Float(std::size_t element, int component) const {
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

bool GltfAccessor::is_unsigned() const {
  return component_type_ == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
         component_type_ == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
         component_type_ == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

std::uint32_t GltfAccessor::Unsigned(std::size_t element, int component) const {
  switch (component_type_) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return Load<std::uint8_t>(element, component);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return Load<std::uint16_t>(element, component);
    default: return Load<std::uint32_t>(element, component);
  }
}

}  // namespace furrow::character

// SPDX-License-Identifier: Apache-2.0
#include "authoring/draco/draco_decoder.h"

#include <memory>
#include <string>
#include <utility>

#include <draco/compression/decode.h>

#include "authoring/draco/draco_wire.h"
#include "gltf/limits.h"

namespace furrow::authoring {
namespace {

// The componentType of an accessor, 0 if glTF has none.
int ComponentType(draco::DataType type) {
  switch (type) {
    case draco::DT_INT8: return 5120;
    case draco::DT_UINT8:
    case draco::DT_BOOL: return 5121;
    case draco::DT_INT16: return 5122;
    case draco::DT_UINT16: return 5123;
    case draco::DT_UINT32: return 5125;
    case draco::DT_FLOAT32: return 5126;
    default: return 0;
  }
}

Result<gltf::DracoAttribute> Copy(const draco::PointAttribute& from, std::uint32_t num_points) {
  gltf::DracoAttribute to{.id = from.unique_id(),
                          .component_type = ComponentType(from.data_type()),
                          .components = from.num_components()};
  const auto element =
      ComponentBytes(to.component_type) * static_cast<std::size_t>(from.num_components());
  if (to.component_type == 0 || from.num_components() < 1 || from.num_components() > 4) {
    return Status(StatusCode::kUnsupported,
                  "attribute " + std::to_string(to.id) + " has a type that glTF does not have");
  }
  to.values.resize(num_points * element);
  for (std::uint32_t point = 0; point < num_points; ++point) {
    const draco::AttributeValueIndex value = from.mapped_index(draco::PointIndex(point));
    if (value.value() >= from.size()) {
      return Status(StatusCode::kParse, "the compressed mesh is damaged");
    }
    from.GetValue(value, to.values.data() + point * element);
  }
  return to;
}

}  // namespace

Result<gltf::DracoMesh> DecodeDraco(std::string_view compressed) {
  draco::DecoderBuffer buffer;
  buffer.Init(compressed.data(), compressed.size());
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok() || decoded.value() == nullptr) {
    return Status(StatusCode::kParse,
                  "the compressed mesh is damaged: " + decoded.status().error_msg_string());
  }
  const draco::Mesh& from = *decoded.value();
  if (from.num_points() > gltf::kMaxVertices || from.num_faces() > gltf::kMaxIndices / 3) {
    return Status(StatusCode::kLimit, "the compressed mesh has too many vertices or triangles");
  }
  gltf::DracoMesh mesh{.num_points = from.num_points()};
  mesh.indices.reserve(std::size_t{from.num_faces()} * 3);
  for (draco::FaceIndex face(0); face < from.num_faces(); ++face) {
    for (const draco::PointIndex corner : from.face(face)) mesh.indices.push_back(corner.value());
  }
  for (int i = 0; i < from.num_attributes(); ++i) {
    Result<gltf::DracoAttribute> attribute = Copy(*from.attribute(i), from.num_points());
    FURROW_RETURN_IF_ERROR(attribute);
    mesh.attributes.push_back(std::move(*attribute));
  }
  return mesh;
}

}  // namespace furrow::authoring

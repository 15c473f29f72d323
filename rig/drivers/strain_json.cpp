// SPDX-License-Identifier: Apache-2.0
#include "rig/drivers/driver_json.h"
#include "rig/json/json_object.h"

namespace furrow::rig {

Status ReadFields(const schema::StrainDriver& from, const std::string&, wrinkle::StrainDriver* to) {
  to->joint = from.joint()->str();
  // All fields read through pointers here are required by the schema. CheckFields() compares their
  // sizes.
  for (const flatbuffers::String* joint : *from.joints()) to->joints.push_back(joint->str());
  for (const schema::PatchVertex* vertex : *from.vertices()) {
    wrinkle::StrainDriver::Vertex& added = to->vertices.emplace_back();
    added.position = ToVec3(*vertex->position());
    added.joints.assign(vertex->joints()->begin(), vertex->joints()->end());
    added.skin_weights.assign(vertex->skin_weights()->begin(), vertex->skin_weights()->end());
  }
  to->triangles.assign(from.triangles()->begin(), from.triangles()->end());
  to->direction = ToVec3(*from.direction());
  to->full_compression = from.full_compression();
  to->size = from.size();
  return {};
}

std::string FieldsToJson(const wrinkle::StrainDriver& strain) {
  const auto vertex = [](const wrinkle::StrainDriver::Vertex& v) {
    return Object()
        .Raw("position", Numbers(v.position))
        .Raw("joints", OnOneLine(v.joints, [](int i) { return std::to_string(i); }))
        .Raw("skin_weights", OnOneLine(v.skin_weights, Number))
        .str();
  };
  return Object()
      .Text("joint", strain.joint)
      .Raw("direction", Numbers(strain.direction))
      .Float("full_compression", strain.full_compression, 0.25f)
      .Float("size", strain.size, 0.0f)
      .Always("joints", strain.joints, Quote)
      .Always("vertices", strain.vertices, vertex)
      .Raw("triangles", OnOneLine(strain.triangles, [](int i) { return std::to_string(i); }))
      .str();
}

}  // namespace furrow::rig

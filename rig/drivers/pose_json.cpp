// SPDX-License-Identifier: Apache-2.0
#include "rig/drivers/driver_json.h"
#include "rig/json/json_object.h"

namespace furrow::rig {
namespace {

std::string PointToJson(const wrinkle::ControlPoint& point) {
  Object object;
  object.Text("joint", point.joint).Choice("kind", point.kind, {"tail", "origin", "offset"});
  if (point.offset != glm::vec3(0)) object.Raw("offset", Numbers(point.offset));
  return object.Float("offset_size", point.offset_size, 0.0f).str();
}

}  // namespace

Status ReadFields(const schema::PoseDriver& from, const std::string& at, wrinkle::PoseDriver* to) {
  to->falloff = from.falloff();
  // The schema requires `values`, so the pointer is not null (rig.fbs).
  for (const schema::PoseValue* value : *from.values()) {
    to->values.push_back({value->name()->str(), value->reference_pose()->str()});
  }
  FURROW_RETURN_IF_ERROR(ReadEnum(from.solve(), &to->solve, at + ".solve"));
  return ForEach(from.points(), at + ".points",
                 [&](const schema::ControlPoint& point, const std::string& where) {
                   wrinkle::ControlPoint& added = to->points.emplace_back();
                   added.joint = point.joint()->str();
                   if (point.offset() != nullptr) added.offset = ToVec3(*point.offset());
                   added.offset_size = point.offset_size();
                   return ReadEnum(point.kind(), &added.kind, where + ".kind");
                 });
}

std::string FieldsToJson(const wrinkle::PoseDriver& pose) {
  const auto value = [](const wrinkle::PoseDriver::Value& v) {
    return Object().Text("name", v.name).Text("reference_pose", v.reference_pose).str();
  };
  return Object()
      .Always("points", pose.points, [](const auto& point) { return PointToJson(point); })
      .Always("values", pose.values, value)
      .Choice("solve", pose.solve, {"projection", "nnls"})
      .Float("falloff", pose.falloff, 0.0f)
      .str();
}

}  // namespace furrow::rig

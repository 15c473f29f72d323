// SPDX-License-Identifier: Apache-2.0
#include "rig/drivers/driver_json.h"
#include "rig/json/json_object.h"

namespace furrow::rig {

Status ReadFields(const schema::TwistDriver& from, const std::string&, wrinkle::TwistDriver* to) {
  to->joint = from.joint()->str();
  if (from.axis() != nullptr) to->axis = ToVec3(*from.axis());
  to->full_degrees = from.full_degrees();
  if (from.through() == nullptr) return {};
  for (const flatbuffers::String* joint : *from.through()) to->through.push_back(joint->str());
  return {};
}

std::string FieldsToJson(const wrinkle::TwistDriver& twist) {
  Object object;
  object.Text("joint", twist.joint);
  if (twist.axis) object.Raw("axis", Numbers(*twist.axis));
  return object.Float("full_degrees", twist.full_degrees, 90.0f)
      .List("through", twist.through, Quote)
      .str();
}

}  // namespace furrow::rig

// SPDX-License-Identifier: Apache-2.0
#include "rig/drivers/driver_json.h"
#include "rig/json/json_object.h"

namespace furrow::rig {

Status ReadFields(const schema::HingeDriver& from, const std::string&, wrinkle::HingeDriver* to) {
  to->parent = from.parent()->str();
  to->joint = from.joint()->str();
  to->end = Text(from.end());
  if (from.axis() != nullptr) to->axis = ToVec3(*from.axis());
  to->beta_degrees = from.beta_degrees();
  return {};
}

std::string FieldsToJson(const wrinkle::HingeDriver& hinge) {
  Object object;
  object.Text("parent", hinge.parent).Text("joint", hinge.joint).Text("end", hinge.end);
  if (hinge.axis) object.Raw("axis", Numbers(*hinge.axis));
  return object.Float("beta_degrees", hinge.beta_degrees, 30.0f).str();
}

}  // namespace furrow::rig

// SPDX-License-Identifier: Apache-2.0
#include "rig/drivers/driver_json.h"
#include "rig/json/json_object.h"

namespace furrow::rig {

Status ReadFields(const schema::BallDriver& from, const std::string& at, wrinkle::BallDriver* to) {
  to->parent = from.parent()->str();
  to->joint = from.joint()->str();
  to->end = Text(from.end());
  if (from.bone() != nullptr) to->bone = ToVec3(*from.bone());
  if (from.forward() != nullptr) to->forward = ToVec3(*from.forward());
  to->beta_degrees = from.beta_degrees();
  return ReadEnum(from.mode(), &to->mode, at + ".mode");
}

std::string FieldsToJson(const wrinkle::BallDriver& ball) {
  Object object;
  object.Text("parent", ball.parent).Text("joint", ball.joint).Text("end", ball.end);
  // Defaults stay out of the file: the reader supplies them again.
  if (ball.bone != glm::vec3(0)) object.Raw("bone", Numbers(ball.bone));
  if (ball.forward != glm::vec3(0, 0, 1)) object.Raw("forward", Numbers(ball.forward));
  return object.Float("beta_degrees", ball.beta_degrees, 30.0f)
      .Choice("mode", ball.mode, {"smooth", "thesis"})
      .str();
}

}  // namespace furrow::rig

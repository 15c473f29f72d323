// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "wrinkle/skeleton/reference_pose.h"

namespace furrow::wrinkle {

class FieldCheck;
class FullPoseBuilder;

// How far joints twist about the bone (swing-twist): values "twist_left" and "twist_right". A
// positive angle is a twist to the left.
struct TwistDriver {
  static constexpr bool kMeasuresFromAnchor = false;
  static constexpr bool kAddsJoints = true;

  std::string joint;
  std::optional<glm::vec3> axis;  // model axes in the rest pose; none: along the joint's tail
  float full_degrees = 90.0f;     // [1, 180]: the angle that gives 1
  std::vector<std::string>
      through;  // more joints, with twists that add up (neck01..03); at most 64

  // The fields as twist.fbs names them, in the order in which they are written.
  template <class Fields>
  static void ListFields(Fields& fields) {
    fields.Required("joint", &TwistDriver::joint);
    fields.Optional("axis", &TwistDriver::axis);
    fields.Optional("full_degrees", &TwistDriver::full_degrees);
    fields.Optional("through", &TwistDriver::through);
  }
};

[[nodiscard]] std::vector<std::string> DriverValueNames(const TwistDriver& driver);
// The value at a twist of `degrees` towards the value's side, [0, 1].
[[nodiscard]] float ValueAtAngle(const TwistDriver& driver, std::string_view value, float degrees);
void CheckFields(const TwistDriver& driver, const std::string& at, FieldCheck* check);
[[nodiscard]] std::vector<std::string> JointsRead(const TwistDriver& driver);
[[nodiscard]] std::vector<std::string> JointsInfluenced(const TwistDriver& driver);
// The full angle, shared evenly by all joints.
[[nodiscard]] Result<ReferencePose> FullPose(const TwistDriver& driver,
                                             const FullPoseBuilder& builder);

}  // namespace furrow::wrinkle

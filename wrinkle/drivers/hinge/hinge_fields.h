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

// A knee or an elbow (4.6): values "flexed" and "extended".
struct HingeDriver {
  static constexpr bool kMeasuresFromAnchor = false;
  static constexpr bool kAddsJoints = false;

  std::string parent;             // upper bone: from this joint's origin to `joint`'s origin
  std::string joint;              // lower bone: from this joint's origin to its tail, or to `end`
  std::string end;                // optional: the joint at the end of the lower bone
  std::optional<glm::vec3> bone;  // the lower bone's direction that counts as straight, model axes
                                  // at rest; none: the upper bone's own direction
  std::optional<glm::vec3> axis;  // model axes in the rest pose; a right-handed turn about it
                                  // flexes. None: bending either way counts, as printed
  // Angle between the bones when fully flexed, [0, 179]; with `bone`, 180 minus the angle from
  // there.
  float beta_degrees = 30.0f;

  // The fields as hinge.fbs names them, in the order in which they are written.
  template <class Fields>
  static void ListFields(Fields& fields) {
    fields.Required("parent", &HingeDriver::parent);
    fields.Required("joint", &HingeDriver::joint);
    fields.Optional("end", &HingeDriver::end);
    fields.Optional("bone", &HingeDriver::bone);
    fields.Optional("axis", &HingeDriver::axis);
    fields.Optional("beta_degrees", &HingeDriver::beta_degrees);
  }
};

[[nodiscard]] std::vector<std::string> DriverValueNames(const HingeDriver& driver);
// The value at a bend of `degrees` from straight (4.6), [0, 1].
[[nodiscard]] float ValueAtAngle(const HingeDriver& driver, std::string_view value, float degrees);
void CheckFields(const HingeDriver& driver, const std::string& at, FieldCheck* check);
[[nodiscard]] std::vector<std::string> JointsRead(const HingeDriver& driver);
[[nodiscard]] std::vector<std::string> JointsInfluenced(const HingeDriver& driver);
// Full flexion about the axis, or ("extended") the straight limb. Without an axis the limb bends
// the way it is bent at rest.
[[nodiscard]] Result<ReferencePose> FullPose(const HingeDriver& driver,
                                             const FullPoseBuilder& builder);

}  // namespace furrow::wrinkle

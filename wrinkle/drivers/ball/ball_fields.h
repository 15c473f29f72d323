// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "wrinkle/skeleton/reference_pose.h"

namespace furrow::wrinkle {

class FieldCheck;
class FullPoseBuilder;

enum class BallMode { kSmooth, kThesis };

// The range of a ball's bend towards one direction, as angles from straight in degrees.
struct BallSide {
  float threshold_degrees = 0.0f;  // the value is 0 up to here, [0, 179]
  float limit_degrees = 0.0f;  // and 1 from here on, (0, 180]; 0: 180 - BallDriver::beta_degrees

  template <class Fields>
  static void ListFields(Fields& fields) {
    fields.Optional("threshold_degrees", &BallSide::threshold_degrees);
    fields.Optional("limit_degrees", &BallSide::limit_degrees);
  }
};

// A hip, a shoulder or a waist: values "front", "back", "left" and "right", the subject's left and
// right.
struct BallDriver {
  static constexpr bool kMeasuresFromAnchor = false;
  static constexpr bool kAddsJoints = false;

  std::string parent;  // joint of the upper bone: gives its direction and its frame
  std::string joint;
  std::string end;       // as HingeDriver::end
  glm::vec3 bone{0.0f};  // the direction that counts as straight, model axes at rest; zero: the
                         // parent bone's own direction
  glm::vec3 forward{0.0f, 0.0f, 1.0f};  // model axes in the rest pose
  float beta_degrees = 30.0f;           // angle between the bones when fully bent, [0, 179]
  BallMode mode = BallMode::kSmooth;
  BallSide front, back, left, right;

  // The fields as ball.fbs names them, in the order in which they are written.
  template <class Fields>
  static void ListFields(Fields& fields) {
    fields.Required("parent", &BallDriver::parent);
    fields.Required("joint", &BallDriver::joint);
    fields.Optional("end", &BallDriver::end);
    fields.Optional("bone", &BallDriver::bone);
    fields.Optional("forward", &BallDriver::forward);
    fields.Optional("beta_degrees", &BallDriver::beta_degrees);
    fields.Choice("mode", &BallDriver::mode, {"smooth", "thesis"});
    fields.Optional("front", &BallDriver::front);
    fields.Optional("back", &BallDriver::back);
    fields.Optional("left", &BallDriver::left);
    fields.Optional("right", &BallDriver::right);
  }
};

// The bend at which the value of `side` is 1, in degrees from straight.
[[nodiscard]] float LimitDegrees(const BallDriver& driver, const BallSide& side);

// A value as a function of the cosine of the bend: clamp((start - cosine) * scale, 0, 1).
struct BallRange {
  float start = 1.0f;
  float scale = 0.0f;
};
[[nodiscard]] BallRange RangeOf(const BallDriver& driver, const BallSide& side);

[[nodiscard]] std::vector<std::string> DriverValueNames(const BallDriver& driver);
// The value at a bend of `degrees` from straight towards the value's side (4.6), [0, 1]. Beyond 120
// degrees the real value may be less (docs/ALGORITHM.md).
[[nodiscard]] float ValueAtAngle(const BallDriver& driver, std::string_view value, float degrees);
void CheckFields(const BallDriver& driver, const std::string& at, FieldCheck* check);
[[nodiscard]] std::vector<std::string> JointsRead(const BallDriver& driver);
[[nodiscard]] std::vector<std::string> JointsInfluenced(const BallDriver& driver);
// The full bend towards the value's side.
[[nodiscard]] Result<ReferencePose> FullPose(const BallDriver& driver,
                                             const FullPoseBuilder& builder);

// The unit direction across `bone` and `forward` (unit, model axes) that counts as the subject's
// right. Characters face +Z with +Y up, so their right is -X. For a bone within 45 degrees of the X
// axis, such as an arm in a T-pose, "right" is the side that is right when the arm hangs: below a
// left arm, above a right arm. A drooping arm thus keeps its sides.
[[nodiscard]] glm::vec3 SubjectsRight(const glm::vec3& bone, const glm::vec3& forward);

}  // namespace furrow::wrinkle

// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/drivers/ball/ball_fields.h"

#include <cmath>

#include "base/scalar.h"
#include "wrinkle/drivers/common/bone_pair.h"
#include "wrinkle/drivers/common/full_pose_builder.h"
#include "wrinkle/fields/field_check.h"

namespace furrow::wrinkle {
namespace {

constexpr float kLeastRangeDegrees = 1.0f;    // a smaller range would act as a switch
constexpr float kSidewaysSine = 0.70710678f;  // of 45 degrees between the bone and the X axis

void CheckSide(const BallDriver& driver, const BallSide& side, const std::string& at,
               FieldCheck* check) {
  check->Range(at, ".limit_degrees", side.limit_degrees, 0.0f, 180.0f);
  check->Range(at, ".threshold_degrees", side.threshold_degrees, 0.0f,
               LimitDegrees(driver, side) - kLeastRangeDegrees);
}

const BallSide& SideOf(const BallDriver& driver, std::string_view value) {
  return value == "front"  ? driver.front
         : value == "back" ? driver.back
         : value == "left" ? driver.left
                           : driver.right;
}

}  // namespace

float LimitDegrees(const BallDriver& driver, const BallSide& side) {
  return side.limit_degrees > 0.0f ? side.limit_degrees : 180.0f - driver.beta_degrees;
}

BallRange RangeOf(const BallDriver& driver, const BallSide& side) {
  // Without a threshold or a limit, the range is exactly that of thesis 4.6, as for hinges.
  if (side.threshold_degrees == 0.0f && side.limit_degrees == 0.0f) {
    return {.start = 1.0f, .scale = BendScale(driver.beta_degrees)};
  }
  const float start = std::cos(side.threshold_degrees * kDegrees);
  const float full = std::cos(LimitDegrees(driver, side) * kDegrees);
  return {.start = start, .scale = 1.0f / (start - full)};
}

float ValueAtAngle(const BallDriver& driver, std::string_view value, float degrees) {
  const BallRange range = RangeOf(driver, SideOf(driver, value));
  return Saturate((range.start - std::cos(degrees * kDegrees)) * range.scale);
}

std::vector<std::string> DriverValueNames(const BallDriver&) {
  return {"front", "back", "left", "right"};
}

void CheckFields(const BallDriver& driver, const std::string& at, FieldCheck* check) {
  check->Label(at, ".parent", driver.parent);
  check->Label(at, ".joint", driver.joint);
  if (!driver.end.empty()) check->Label(at, ".end", driver.end);
  if (driver.bone != glm::vec3(0.0f)) check->Direction(at, ".bone", driver.bone);
  check->Direction(at, ".forward", driver.forward);
  check->Range(at, ".beta_degrees", driver.beta_degrees, 0.0f, kMaxBetaDegrees);
  CheckSide(driver, driver.front, at + ".front", check);
  CheckSide(driver, driver.back, at + ".back", check);
  CheckSide(driver, driver.left, at + ".left", check);
  CheckSide(driver, driver.right, at + ".right", check);
}

std::vector<std::string> JointsRead(const BallDriver& driver) {
  return {driver.parent, driver.joint, driver.end};
}

std::vector<std::string> JointsInfluenced(const BallDriver& driver) { return {driver.joint}; }

Result<ReferencePose> FullPose(const BallDriver& driver, const FullPoseBuilder& builder) {
  const Result<Limb> limb = builder.FindLimb(driver.parent, driver.joint, driver.end);
  FURROW_RETURN_IF_ERROR(limb);
  const glm::vec3 straight = driver.bone == glm::vec3(0.0f) ? limb->upper : Direction(driver.bone);
  const glm::vec3 front = AcrossBone(driver.forward, straight);
  // Bind() rejects the same directions (kLeastAcross).
  if (straight == glm::vec3(0.0f) || front == glm::vec3(0.0f)) {
    return builder.CannotPose("forward lies along the straight direction");
  }
  const glm::vec3 right = SubjectsRight(straight, front);
  const std::string_view value = builder.value();
  const glm::vec3 towards = value == "front"  ? front
                            : value == "back" ? -front
                            : value == "left" ? -right
                                              : right;
  const float limit = builder.degrees().value_or(LimitDegrees(driver, SideOf(driver, value)));
  return builder.Bent(*limb, straight, towards, 180.0f - limit);
}

glm::vec3 SubjectsRight(const glm::vec3& bone, const glm::vec3& forward) {
  // A character faces +Z with Y up, so its right is -X. The sides of a bone that lies sideways have
  // almost no X, and its sign would depend on how far an arm droops. There, right is where it would
  // be if the arm hung: the sign changes only for arms that are raised by 45 degrees or more.
  const glm::vec3 side = Direction(glm::cross(bone, forward));
  const bool is_sideways = std::abs(side.x) < kSidewaysSine;
  const bool flip = is_sideways ? forward.z < 0.0f : side.x > 0.0f;
  return flip ? -side : side;
}

}  // namespace furrow::wrinkle

// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/rig/full_pose.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtx/quaternion.hpp>

#include "base/scalar.h"
#include "base/status.h"
#include "wrinkle/drivers/ball/ball_driver.h"
#include "wrinkle/drivers/hinge/hinge.h"
#include "wrinkle/rig/driver_values.h"

namespace furrow::wrinkle {
namespace {

// Bones that lie on each other this closely (cosine) tell no way to bend.
constexpr float kAlmostStraight = 0.9998f;  // about 1 degree

// What of a direction is across a bone, unit; zero where a driver refuses it: too nearly along.
glm::vec3 Across(const glm::vec3& direction, const glm::vec3& bone) {
  const glm::vec3 unit = Direction(direction);
  const glm::vec3 across = unit - glm::dot(unit, bone) * bone;
  return glm::length(across) < kLeastAcross ? glm::vec3(0.0f) : Direction(across);
}

// The joint and its two bones at rest, unit directions in model axes.
struct Limb {
  int joint = kNoJoint;
  glm::vec3 upper{0.0f};
  glm::vec3 lower{0.0f};
};

class FullPoseMaker {
 public:
  FullPoseMaker(const Driver& driver, std::string_view value, const Skeleton& skeleton)
      : driver_(driver), value_(value), skeleton_(skeleton) {}

  Result<ReferencePose> Hinge() const {
    const HingeDriver& hinge = driver_.hinge;
    const Result<Limb> limb = FindLimb(hinge.parent, hinge.joint, hinge.end);
    FURROW_RETURN_IF_ERROR(limb);
    if (limb->upper == glm::vec3(0.0f)) return Senseless("its upper bone has no length");
    if (value_ == "extended") return Turned(*limb, limb->upper, limb->upper);
    const glm::vec3 given = hinge.axis.value_or(glm::cross(limb->upper, limb->lower));
    const bool straight = glm::dot(limb->upper, limb->lower) > kAlmostStraight;
    if (!hinge.axis && straight) {
      return Senseless("it states no axis, and the limb is straight at rest");
    }
    const glm::vec3 axis = Across(given, limb->upper);
    if (axis == glm::vec3(0.0f)) return Senseless("its axis lies along the upper bone");
    return Bent(*limb, limb->upper, glm::cross(axis, limb->upper), hinge.beta_degrees);
  }

  Result<ReferencePose> Ball() const {
    const BallDriver& ball = driver_.ball;
    const Result<Limb> limb = FindLimb(ball.parent, ball.joint, ball.end);
    FURROW_RETURN_IF_ERROR(limb);
    const glm::vec3 straight = ball.bone == glm::vec3(0.0f) ? limb->upper : Direction(ball.bone);
    const glm::vec3 front = Across(ball.forward, straight);
    if (straight == glm::vec3(0.0f) || front == glm::vec3(0.0f)) {
      return Senseless("forward lies along the straight direction");
    }
    const glm::vec3 right = SubjectsRight(straight, front);
    const glm::vec3 towards = value_ == "front"  ? front
                              : value_ == "back" ? -front
                              : value_ == "left" ? -right
                                                 : right;
    return Bent(*limb, straight, towards, ball.beta_degrees);
  }

  Result<ReferencePose> Twist() const {
    const TwistDriver& twist = driver_.twist;
    std::vector<std::string> names = {twist.joint};
    names.insert(names.end(), twist.through.begin(), twist.through.end());
    const float sign = value_ == "twist_left" ? 1.0f : -1.0f;
    const float angle = sign * twist.full_degrees * kDegrees / static_cast<float>(names.size());
    ReferencePose pose = Named();
    for (const std::string& name : names) {
      const int joint = skeleton_.Find(name);
      if (joint == kNoJoint) return Missing(name);
      const glm::vec3 own = skeleton_.rest_model_rotations()[joint] * skeleton_.tails()[joint];
      const glm::vec3 axis = Direction(twist.axis.value_or(own));
      if (axis == glm::vec3(0.0f)) return Senseless("joint '" + name + "' has no tail");
      pose.joints.push_back({.joint = name, .rotation = glm::angleAxis(angle, axis)});
    }
    return pose;
  }

  [[nodiscard]] Status Senseless(const std::string& why) const {
    return {StatusCode::kInvalidArgument, "driver '" + driver_.name + "' cannot be posed: " + why};
  }
  [[nodiscard]] Status Missing(const std::string& joint) const {
    return {StatusCode::kNotFound, "driver '" + driver_.name + "' names joint '" + joint +
                                       "', which the skeleton does not have"};
  }

 private:
  [[nodiscard]] glm::vec3 Origin(int joint) const { return skeleton_.rest_model()[joint][3]; }

  Result<Limb> FindLimb(const std::string& parent, const std::string& joint,
                        const std::string& end) const {
    const int parent_index = skeleton_.Find(parent);
    if (parent_index == kNoJoint) return Missing(parent);
    Limb limb;
    limb.joint = skeleton_.Find(joint);
    if (limb.joint == kNoJoint) return Missing(joint);
    const int end_index = end.empty() ? limb.joint : skeleton_.Find(end);
    if (end_index == kNoJoint) return Missing(end);
    const glm::vec3 tip = end.empty() ? glm::vec3(skeleton_.rest_model()[limb.joint] *
                                                  glm::vec4(skeleton_.tails()[limb.joint], 1.0f))
                                      : Origin(end_index);
    limb.upper = Direction(Origin(limb.joint) - Origin(parent_index));
    limb.lower = Direction(tip - Origin(limb.joint));
    if (limb.lower == glm::vec3(0.0f)) return Senseless("its lower bone has no length");
    return limb;
  }

  // The lower bone bent fully from `straight` towards `side`, which lies across it.
  ReferencePose Bent(const Limb& limb, const glm::vec3& straight, const glm::vec3& side,
                     float beta_degrees) const {
    const float angle = kPi - beta_degrees * kDegrees;
    return Turned(limb, std::cos(angle) * straight + std::sin(angle) * side, side);
  }

  // The lower bone turned the shortest way to `target`; by way of `side` where all ways are as
  // short.
  ReferencePose Turned(const Limb& limb, const glm::vec3& target, const glm::vec3& side) const {
    ReferencePose pose = Named();
    glm::quat turn = glm::rotation(limb.lower, target);
    if (glm::dot(limb.lower, target) < -kAlmostStraight) {
      const glm::vec3 axis = Direction(glm::cross(limb.lower, side));
      if (axis != glm::vec3(0.0f)) turn = glm::angleAxis(kPi, axis);
    }
    pose.joints.push_back({.joint = skeleton_.joint_names()[limb.joint], .rotation = turn});
    return pose;
  }

  [[nodiscard]] ReferencePose Named() const {
    return {.name = driver_.name + "." + std::string(value_)};
  }

  const Driver& driver_;
  std::string_view value_;
  const Skeleton& skeleton_;
};

Result<ReferencePose> OfPoseDriver(const Rig& rig, const Driver& driver, std::string_view value) {
  for (const PoseDriver::Value& v : driver.pose.values) {
    if (v.name != value) continue;
    for (const ReferencePose& pose : rig.reference_poses) {
      if (pose.name == v.reference_pose) return pose;
    }
    return Status(StatusCode::kNotFound, "driver '" + driver.name + "' names reference pose '" +
                                             v.reference_pose + "', which the rig does not have");
  }
  return Status(StatusCode::kInternal, "driver '" + driver.name + "' lost a value");
}

}  // namespace

Result<ReferencePose> FullPose(const Rig& rig, const Driver& driver, std::string_view value,
                               const Skeleton& skeleton) {
  const std::vector<std::string> values = DriverValueNames(driver);
  if (std::find(values.begin(), values.end(), value) == values.end()) {
    return Status(StatusCode::kNotFound,
                  "driver '" + driver.name + "' has no value '" + std::string(value) + "'");
  }
  const FullPoseMaker maker(driver, value, skeleton);
  switch (driver.kind) {
    case Driver::Kind::kPose: return OfPoseDriver(rig, driver, value);
    case Driver::Kind::kHinge: return maker.Hinge();
    case Driver::Kind::kBall: return maker.Ball();
    case Driver::Kind::kTwist: return maker.Twist();
    case Driver::Kind::kBlendShape:
    case Driver::Kind::kStrain: break;
  }
  return Status(StatusCode::kUnsupported,
                "driver '" + driver.name + "' is not raised by a pose of joints");
}

}  // namespace furrow::wrinkle

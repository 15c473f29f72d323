// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/recordings/frame_pose.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtx/quaternion.hpp>

#include "base/scalar.h"
#include "base/status.h"

namespace furrow::authoring {
namespace {

using glm::quat;
using glm::vec3;

quat About(float degrees, const vec3& axis) { return glm::angleAxis(degrees * kDegrees, axis); }

std::string Sided(const std::string& joint, float side) {
  return joint + (side > 0.0f ? "_l" : "_r");
}

}  // namespace

FramePose::FramePose(const wrinkle::Rig& rig, const wrinkle::Skeleton& skeleton)
    : rig_(rig),
      skeleton_(skeleton),
      frame_(skeleton.rest_pose().begin(), skeleton.rest_pose().end()) {}

Status FramePose::Apply(const std::string& pose, float weight) {
  const auto found = std::find_if(rig_.reference_poses.begin(), rig_.reference_poses.end(),
                                  [&](const wrinkle::ReferencePose& p) { return p.name == pose; });
  if (found == rig_.reference_poses.end()) {
    return Status(StatusCode::kNotFound, "the rig has no reference pose '" + pose + "'");
  }
  const float scale = wrinkle::ReferencePoseScale(*found, skeleton_);
  for (const wrinkle::JointDelta& delta : found->joints) {
    const int joint = skeleton_.Find(delta.joint);
    if (joint == wrinkle::kNoJoint) {
      return Status(StatusCode::kNotFound, "the skeleton has no joint '" + delta.joint + "'", pose);
    }
    frame_[joint].translation += (delta.translation * scale + delta.unscaled_translation) * weight;
    frame_[joint].rotation =
        frame_[joint].rotation * glm::slerp(quat(1, 0, 0, 0), delta.rotation, weight);
  }
  return Status();
}

Status FramePose::ApplyBoth(const std::string& pose, float left, float right) {
  const bool sided =
      std::any_of(rig_.reference_poses.begin(), rig_.reference_poses.end(),
                  [&](const wrinkle::ReferencePose& p) { return p.name == pose + "_l"; });
  if (!sided) return Apply(pose, left);
  FURROW_RETURN_IF_ERROR(Apply(pose + "_l", left));
  return Apply(pose + "_r", right);
}

void FramePose::Turn(const std::string& joint, float x, float y, float z) {
  const int index = skeleton_.Find(joint);
  if (index == wrinkle::kNoJoint) return;
  frame_[index].rotation =
      frame_[index].rotation * About(z, {0, 0, 1}) * About(y, {0, 1, 0}) * About(x, {1, 0, 0});
}

void FramePose::TurnBoth(const std::string& joint, float x, float y, float z) {
  Turn(Sided(joint, 1.0f), x, y, z);
  Turn(Sided(joint, -1.0f), x, -y, -z);
}

void FramePose::Move(const std::string& joint, const vec3& by) {
  const int index = skeleton_.Find(joint);
  if (index != wrinkle::kNoJoint) frame_[index].translation += by;
}

quat FramePose::ModelRotation(int joint) const {
  quat rotation(1, 0, 0, 0);
  for (int j = joint; j != wrinkle::kNoJoint; j = skeleton_.joint_parents()[j]) {
    rotation = frame_[j].rotation * rotation;
  }
  return rotation;
}

vec3 FramePose::PlaceOf(const std::string& joint) const {
  vec3 place(0.0f);
  for (int j = skeleton_.Find(joint); j != wrinkle::kNoJoint; j = skeleton_.joint_parents()[j]) {
    place = frame_[j].translation + frame_[j].rotation * place;
  }
  return place;
}

void FramePose::PlantFoot(float side, const vec3& ankle, float heel_up, float outward) {
  const int thigh = skeleton_.Find(Sided("upper_leg", side));
  const int shin = skeleton_.Find(Sided("lower_leg", side));
  const int foot = skeleton_.Find(Sided("foot", side));
  if (thigh == wrinkle::kNoJoint || shin == wrinkle::kNoJoint || foot == wrinkle::kNoJoint) return;
  const quat hips = ModelRotation(skeleton_.joint_parents()[thigh]);
  const vec3 want = glm::inverse(hips) * (ankle - PlaceOf(Sided("upper_leg", side)));
  const vec3 upper = frame_[shin].translation;
  const vec3 lower = frame_[foot].translation;
  // Bending the knee brings the ankle closer to the hip, so bisection finds the angle.
  float straight = 0.0f, bent = 150.0f;
  for (int i = 0; i < 24; ++i) {
    const float middle = 0.5f * (straight + bent);
    const vec3 reach = upper + About(middle, {1, 0, 0}) * lower;
    (glm::length(reach) > glm::length(want) ? straight : bent) = middle;
  }
  const quat knee = About(straight, {1, 0, 0});
  const quat hip = glm::rotation(glm::normalize(upper + knee * lower), glm::normalize(want));
  frame_[thigh].rotation = hip;
  frame_[shin].rotation = knee;
  const quat pitch = About(side * outward, {0, 1, 0}) * About(heel_up, {1, 0, 0});
  frame_[foot].rotation = glm::inverse(hips * hip * knee) * pitch;
}

void FramePose::CloseHand(float side, float fist) {
  struct Bend {
    const char* joint;
    float relaxed;  // degrees
    float closed;
  };
  constexpr Bend kBends[] = {
      {"proximal", 14.0f, 82.0f}, {"intermediate", 20.0f, 98.0f}, {"distal", 10.0f, 60.0f}};
  constexpr const char* kFingers[] = {"index", "middle", "ring", "little"};
  for (int i = 0; i < 4; ++i) {
    const float more =
        1.0f +
        0.14f * static_cast<float>(i);  // relaxed fingers curl more from index to little finger
    for (const Bend& bend : kBends) {
      const float angle = bend.relaxed * more * (1.0f - fist) + bend.closed * fist;
      Turn(Sided(std::string(kFingers[i]) + "_" + bend.joint, side), 0, 0, -side * angle);
    }
  }
  // The thumb closes across the fingers.
  Turn(Sided("thumb_metacarpal", side), 25.0f * fist, side * (8.0f + 18.0f * fist), 0);
  Turn(Sided("thumb_proximal", side), 0, side * (6.0f + 34.0f * fist), 0);
  Turn(Sided("thumb_distal", side), 0, side * (10.0f + 45.0f * fist), 0);
}

}  // namespace furrow::authoring

// SPDX-License-Identifier: Apache-2.0
#include "rig/rig_reference_pose.h"

#include <cmath>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "base/status.h"
#include "wrinkle/skeleton/retarget.h"

namespace furrow::rig {
namespace {

using wrinkle::JointDelta;
using wrinkle::PoseFrame;
using wrinkle::ReferencePose;
using wrinkle::Skeleton;
using wrinkle::Transform;

constexpr float kLeastRadians = 1e-5f;
constexpr float kLeastTranslation = 1e-6f;  // of the skeleton's size

// The angle of the shorter turn, in radians.
float Angle(const glm::quat& q) {
  return 2.0f * std::atan2(glm::length(glm::vec3(q.x, q.y, q.z)), std::abs(q.w));
}

// q and -q are the same rotation. A w of 0 or more gives the shorter turn.
glm::quat ShorterWay(const glm::quat& q) { return q.w < 0.0f ? -q : q; }

// exp(weight * log(q)), by the shorter rotation.
glm::quat Scaled(const glm::quat& rotation, float weight) {
  if (weight == 1.0f) return rotation;
  const glm::quat q = ShorterWay(rotation);
  const glm::vec3 v(q.x, q.y, q.z);
  const float sine = glm::length(v);
  // Too small a turn for an axis.
  if (sine < 1e-9f) return {1.0f, 0.0f, 0.0f, 0.0f};
  const float half = std::atan2(sine, q.w) * weight;
  return {std::cos(half), v * (std::sin(half) / sine)};
}

// Frames come from recordings. Every number must be finite before it enters a rig.
Status CheckPose(const PoseFrame& frame, const Skeleton& skeleton) {
  if (static_cast<int>(frame.pose.joints.size()) != skeleton.num_joints()) {
    return {StatusCode::kInvalidArgument,
            "the frame has " + std::to_string(frame.pose.joints.size()) +
                " joints, but its skeleton has " + std::to_string(skeleton.num_joints())};
  }
  for (int j = 0; j < skeleton.num_joints(); ++j) {
    if (!wrinkle::IsValid(frame.pose.joints[j])) {
      return {StatusCode::kNonFinite,
              "the transform of joint '" + skeleton.joint_names()[j] + "' is invalid"};
    }
  }
  return {};
}

}  // namespace

glm::quat FromEulerDegrees(const glm::vec3& degrees) {
  const glm::vec3 radians = glm::radians(degrees);
  return glm::angleAxis(radians.z, glm::vec3(0, 0, 1)) *
         glm::angleAxis(radians.y, glm::vec3(0, 1, 0)) *
         glm::angleAxis(radians.x, glm::vec3(1, 0, 0));
}

Result<ReferencePose> ReferencePoseFromFrame(std::string name, const PoseFrame& frame,
                                             const PoseFrame* rest) {
  const Skeleton& skeleton = frame.skeleton;
  FURROW_RETURN_IF_ERROR(CheckPose(frame, skeleton));
  if (rest != nullptr) {
    FURROW_RETURN_IF_ERROR(CheckPose(*rest, skeleton));
  }
  ReferencePose pose;
  pose.name = std::move(name);
  pose.source_size = wrinkle::SkeletonSize(skeleton);

  const std::span<const glm::quat> axes = skeleton.rest_model_rotations();
  for (int j = 0; j < skeleton.num_joints(); ++j) {
    const Transform& still = rest != nullptr ? rest->pose.joints[j] : skeleton.rest_pose()[j];
    const Transform& moved = frame.pose.joints[j];
    const int parent = skeleton.joint_parents()[j];
    const glm::quat above = parent < 0 ? glm::quat(1, 0, 0, 0) : axes[parent];
    // The departure in the joint's own axes, expressed in model axes of the skeleton's rest pose,
    // as JointDelta defines them. The rotations of `rest` must not enter here: they contain the
    // performer's heading and the tilt of the head.
    const glm::quat& g = axes[j];
    JointDelta delta;
    delta.joint = skeleton.joint_names()[j];
    delta.rotation = ShorterWay(
        glm::normalize(g * glm::inverse(still.rotation) * moved.rotation * glm::inverse(g)));
    delta.translation = above * (moved.translation - still.translation);
    // Recordings repeat the rest pose in rounded numbers. Joints that only differ by rounding stay
    // out of the pose, so that rigs stay small and blends exact.
    const bool turns = Angle(delta.rotation) > kLeastRadians;
    const bool shifts = glm::length(delta.translation) > kLeastTranslation * pose.source_size;
    if (!turns) delta.rotation = {1.0f, 0.0f, 0.0f, 0.0f};
    if (!shifts) delta.translation = glm::vec3(0.0f);
    if (turns || shifts) pose.joints.push_back(std::move(delta));
  }
  return pose;
}

ReferencePose MixReferencePoses(std::string name, std::span<const WeightedPose> parts) {
  ReferencePose mix;
  mix.name = std::move(name);
  // The units of the first part that states a size.
  for (const WeightedPose& part : parts) {
    if (mix.source_size == 0.0f) mix.source_size = part.pose->source_size;
  }
  std::unordered_map<std::string, std::size_t> places;
  for (const WeightedPose& part : parts) {
    // Parts without a size are in units of the bound skeleton, whatever its size. Their
    // translations cannot be converted here, and stay apart if the mix states a size.
    const float size = part.pose->source_size;
    const bool apart = size == 0.0f && mix.source_size > 0.0f;
    const float scale = size > 0.0f ? mix.source_size / size : 1.0f;
    for (const JointDelta& delta : part.pose->joints) {
      // Joints keep the order of their first appearance, so that files do not change between runs.
      const auto [place, added] = places.emplace(delta.joint, mix.joints.size());
      if (added) mix.joints.push_back({.joint = delta.joint});
      JointDelta& sum = mix.joints[place->second];
      sum.rotation = Scaled(delta.rotation, part.weight) * sum.rotation;
      glm::vec3& translation = apart ? sum.unscaled_translation : sum.translation;
      translation += delta.translation * (part.weight * scale);
      sum.unscaled_translation += delta.unscaled_translation * part.weight;
    }
  }
  for (JointDelta& sum : mix.joints) {
    sum.rotation = ShorterWay(sum.rotation);
    // A mix of one pose stays the same to the bit, so that files do not change when they are
    // written again.
    const float square = glm::dot(sum.rotation, sum.rotation);
    if (std::abs(square - 1.0f) > 1e-6f) sum.rotation = glm::normalize(sum.rotation);
  }
  return mix;
}

}  // namespace furrow::rig

// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/shapes/blend_shape_pose.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "base/ascii.h"
#include "wrinkle/skeleton/finite.h"
#include "wrinkle/skeleton/reference_pose.h"

namespace furrow::wrinkle {
namespace {

bool HasName(std::span<const std::string> names, const std::string& name) {
  return std::ranges::any_of(names,
                             [&](const std::string& one) { return EqualsIgnoreCase(one, name); });
}

// The blend shape that limits the coefficient of `name`, or -1.
int LimitOf(const std::string& name, std::span<const std::string> blend_shapes) {
  if (!EqualsIgnoreCase(name, "mouthClose")) return -1;
  const auto jaw = std::ranges::find_if(
      blend_shapes, [](const std::string& one) { return EqualsIgnoreCase(one, "jawOpen"); });
  return jaw == blend_shapes.end() ? -1 : static_cast<int>(jaw - blend_shapes.begin());
}

float CoefficientOf(int blend_shape, std::span<const float> coefficients) {
  const auto shape = static_cast<std::size_t>(blend_shape);
  return shape < coefficients.size() ? coefficients[shape] : 0.0f;
}

}  // namespace

BlendShapePose BlendShapePose::Create(const Rig& rig, const Skeleton& skeleton,
                                      std::span<const std::string> blend_shapes,
                                      std::span<const std::string> shapes) {
  BlendShapePose result;
  result.num_joints_ = static_cast<std::size_t>(skeleton.num_joints());
  for (std::size_t shape = 0; shape < blend_shapes.size(); ++shape) {
    const auto pose = std::find_if(
        rig.reference_poses.begin(), rig.reference_poses.end(),
        [&](const ReferencePose& p) { return EqualsIgnoreCase(p.name, blend_shapes[shape]); });
    if (pose == rig.reference_poses.end() || HasName(shapes, blend_shapes[shape])) continue;
    const float scale = ReferencePoseScale(*pose, skeleton);
    for (const JointDelta& delta : pose->joints) {
      const int joint = skeleton.Find(delta.joint);
      if (joint == kNoJoint || IsRest(delta)) continue;
      const Transform& rest = skeleton.rest_pose()[joint];
      Transform moved = rest;
      ApplyJointDelta(delta, skeleton, joint, scale, &moved);
      // Stored as axis and angle of the shorter turn, because a coefficient scales the angle.
      glm::quat turn = glm::normalize(glm::conjugate(rest.rotation) * moved.rotation);
      if (turn.w < 0.0f) turn = -turn;
      const glm::vec3 vector(turn.x, turn.y, turn.z);
      const float sine = glm::length(vector);
      result.moves_.push_back({.blend_shape = static_cast<int>(shape),
                               .at_most = LimitOf(blend_shapes[shape], blend_shapes),
                               .joint = joint,
                               .translation = moved.translation - rest.translation,
                               // Turns too small for an axis keep any axis and an angle near 0.
                               .axis = sine > 1e-7f ? vector / sine : glm::vec3(1, 0, 0),
                               .angle = 2.0f * std::atan2(sine, turn.w)});
    }
  }
  return result;
}

JobStatus BlendShapePose::Run(std::span<const float> coefficients,
                              std::span<Transform> local) const {
  if (moves_.empty()) return JobStatus::kOk;
  if (local.size() < num_joints_) return JobStatus::kSizeMismatch;
  if (!AllFinite(coefficients)) return JobStatus::kNonFinite;
  for (const Move& move : moves_) {
    float amount = CoefficientOf(move.blend_shape, coefficients);
    if (move.at_most >= 0) {
      amount = std::min(amount, std::max(CoefficientOf(move.at_most, coefficients), 0.0f));
    }
    if (amount == 0.0f) continue;
    Transform& joint = local[static_cast<std::size_t>(move.joint)];
    joint.translation += amount * move.translation;
    joint.rotation =
        glm::normalize(joint.rotation * glm::angleAxis(amount * move.angle, move.axis));
  }
  return JobStatus::kOk;
}

}  // namespace furrow::wrinkle

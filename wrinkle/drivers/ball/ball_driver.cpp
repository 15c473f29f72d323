// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/drivers/ball/ball_driver.h"

#include <cmath>

#include <glm/geometric.hpp>

#include "wrinkle/drivers/ball/ball.h"
#include "wrinkle/drivers/hinge/hinge.h"
#include "wrinkle/rig/driver_values.h"

namespace furrow::wrinkle {

glm::vec3 SubjectsRight(const glm::vec3& bone, const glm::vec3& forward) {
  const glm::vec3 side = Direction(glm::cross(bone, forward));
  const float towards_right = -side.x;
  const float decisive = std::abs(towards_right) > kLeastAcross ? towards_right : side.y;
  return decisive < 0.0f ? -side : side;
}

Status BallDriverSet::Bind(const Driver& driver, int first_value, BindContext* context) {
  const BallDriver& ball = driver.ball;
  const std::string whose = "driver '" + driver.name + "'";
  const Skeleton& skeleton = context->skeleton();
  const bool own_direction = ball.bone == glm::vec3(0.0f);
  Entry entry;
  entry.first_value = first_value;
  entry.bend_scale = BendScale(ball.beta_degrees);
  entry.mode = ball.mode;
  bool usable = false;
  if (Status status = BindBonePair(whose, ball.parent, ball.joint, ball.end, own_direction, context,
                                   &entry.bones, &usable);
      !status.ok() || !usable) {
    return status;
  }
  const int parent = entry.bones.parent;
  glm::vec3 bone = Direction(ball.bone);  // model axes
  if (own_direction) {
    bone = skeleton.rest_model_rotations()[parent] *
           entry.bones.Upper(skeleton.rest_pose(), context->chains());
  } else {
    entry.straight = ToJointAxes(skeleton, parent, bone);
  }
  const glm::vec3 forward = Direction(ball.forward);
  const glm::vec3 across = forward - glm::dot(forward, bone) * bone;
  if (glm::length(across) < kLeastAcross) {
    return context->Unusable(whose, "forward lies along the straight direction");
  }
  entry.forward = ToJointAxes(skeleton, parent, Direction(across));
  entry.right = ToJointAxes(skeleton, parent, SubjectsRight(bone, Direction(across)));
  entries_.push_back(entry);
  return {};
}

BallDriverSet::Bending BallDriverSet::MeasureEntry(const Entry& entry,
                                                   std::span<const Transform> local,
                                                   const JointChains& chains) {
  const glm::vec3 none(0.0f);
  const glm::vec3 straight =
      entry.straight == none ? entry.bones.Upper(local, chains) : entry.straight;
  const glm::vec3 lower = entry.bones.Lower(local, chains);
  if (straight == none || lower == none) return {};
  const float cosine = glm::dot(straight, lower);
  const glm::vec3 across = lower - cosine * straight;
  return {.cosine = cosine,
          .forward = glm::dot(across, entry.forward),
          .right = glm::dot(across, entry.right)};
}

BallDriverSet::Bending BallDriverSet::Measure(int entry, std::span<const Transform> local,
                                              const JointChains& chains) const {
  return MeasureEntry(entries_[entry], local, chains);
}

void BallDriverSet::Evaluate(std::span<const Transform> local, const JointChains& chains,
                             std::span<float> driver_values) const {
  for (const Entry& entry : entries_) {
    if (!Reaches(driver_values, entry.first_value)) break;
    const Bending bending = MeasureEntry(entry, local, chains);
    const float bend = Bend(bending.cosine, entry.bend_scale);
    const BallShares shares = SplitBend(entry.mode, bend, bending.forward, bending.right);
    const std::span<float> out = driver_values.subspan(static_cast<std::size_t>(entry.first_value));
    out[0] = shares.front;
    out[1] = shares.back;
    out[2] = shares.left;
    out[3] = shares.right;
  }
}

}  // namespace furrow::wrinkle

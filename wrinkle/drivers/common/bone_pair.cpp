// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/drivers/common/bone_pair.h"

#include <algorithm>
#include <cmath>

#include "base/scalar.h"

namespace furrow::wrinkle {
namespace {

constexpr float kLeastBendRange = 1e-6f;  // of 1 + cos(beta)

}  // namespace

float BendScale(float beta_degrees) {
  const float range = 1.0f + std::cos(beta_degrees * kDegrees);
  return range < kLeastBendRange ? 0.0f : 1.0f / range;
}

glm::vec3 BonePair::Upper(std::span<const Transform> local, const JointChains& chains) const {
  return Direction(chains.Evaluate(local, joint_point));
}

glm::vec3 BonePair::Lower(std::span<const Transform> local, const JointChains& chains) const {
  return Direction(chains.Evaluate(local, end_point) - chains.Evaluate(local, joint_point));
}

Status BindBonePair(std::string_view owner, const std::string& parent, const std::string& joint,
                    const std::string& end, bool need_upper, BindContext* context, BonePair* pair,
                    bool* usable) {
  *usable = false;
  const Skeleton& skeleton = context->skeleton();
  const Result<int> parent_index = context->Joint(owner, "parent", parent);
  FURROW_RETURN_IF_ERROR(parent_index);
  const Result<int> joint_index = context->Joint(owner, "joint", joint);
  FURROW_RETURN_IF_ERROR(joint_index);
  const Result<int> end_index = end.empty() ? *joint_index : context->Joint(owner, "end", end);
  FURROW_RETURN_IF_ERROR(end_index);
  pair->parent = *parent_index;
  pair->joint = *joint_index;
  if (pair->parent == kNoJoint || pair->joint == kNoJoint || *end_index == kNoJoint) return {};
  if (pair->parent == pair->joint || !skeleton.IsAncestor(pair->parent, pair->joint)) {
    return context->Unusable(owner, "parent '" + parent + "' is not above joint '" + joint + "'");
  }
  if (!end.empty() &&
      (*end_index == pair->joint || !skeleton.IsAncestor(pair->joint, *end_index))) {
    return context->Unusable(owner, "end '" + end + "' is not below joint '" + joint + "'");
  }

  // Both points are measured in the parent's space. The parent's own motion therefore cancels out.
  const glm::vec3 end_offset = end.empty() ? skeleton.tails()[pair->joint] : glm::vec3(0.0f);
  JointChains& chains = context->chains();
  pair->joint_point = chains.Add(skeleton, pair->joint, glm::vec3(0.0f), pair->parent);
  pair->end_point = chains.Add(skeleton, *end_index, end_offset, pair->parent);
  const glm::vec3 none(0.0f);
  if (need_upper && pair->Upper(skeleton.rest_pose(), chains) == none) {
    return context->Unusable(owner,
                             "the bone from '" + parent + "' to '" + joint + "' has no length");
  }
  if (pair->Lower(skeleton.rest_pose(), chains) == none) {
    return context->Unusable(owner, "the bone below '" + joint + "' has no length");
  }
  *usable = true;
  return {};
}

// Rows of one driver kind: a row per value, a lane per driver. `entries` fills the lanes from 0.
void PlanBones(std::span<const BoneEntry> entries, std::size_t num_values, LanePlanner* planner,
               BoneBlock* block) {
  Lanes joints;
  Lanes ends;
  block->first_row = planner->AddRows(num_values);
  for (const BoneEntry& entry : entries) {
    const std::size_t lane = joints.count;
    planner->Place(entry.first_value, num_values, lane, block);
    joints.Add(entry.bones.joint_point);
    ends.Add(entry.bones.end_point);
  }
  block->joint_point = planner->AddPoints(joints);
  block->end_point = planner->AddPoints(ends);
}

}  // namespace furrow::wrinkle

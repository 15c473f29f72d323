// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/skeleton/joint_chain.h"

#include <algorithm>

namespace furrow::wrinkle {

int JointChains::Add(const Skeleton& skeleton, int joint, const glm::vec3& offset, int base) {
  Point point;
  point.offset = offset;
  point.first = static_cast<std::uint32_t>(joints_.size());
  // Climbs to the lowest joint that is the base or above it. Transforms above this shared joint
  // cancel out, so points do not depend on the character's place.
  int shared = joint;
  while (shared != kNoJoint && (base == kNoJoint || !skeleton.IsAncestor(shared, base))) {
    joints_.push_back(static_cast<std::int16_t>(shared));
    ++point.num_up;
    shared = skeleton.joint_parents()[shared];
  }
  for (int down = base; down != shared; down = skeleton.joint_parents()[down]) {
    joints_.push_back(static_cast<std::int16_t>(down));
    ++point.num_down;
  }
  std::reverse(joints_.end() - point.num_down, joints_.end());
  points_.push_back(point);
  return static_cast<int>(points_.size()) - 1;
}

glm::vec3 JointChains::Evaluate(std::span<const Transform> local, int point) const {
  // lane_points-inl.h has the same order of operations, so that both give the same bits.
  const Point& chain = points_[point];
  const std::int16_t* joint = joints_.data() + chain.first;
  glm::vec3 position = chain.offset;
  for (const std::int16_t* const end = joint + chain.num_up; joint != end; ++joint) {
    const Transform& t = local[*joint];
    position = t.translation + t.rotation * (t.scale * position);
  }
  for (const std::int16_t* const end = joint + chain.num_down; joint != end; ++joint) {
    const Transform& t = local[*joint];
    position = (glm::conjugate(t.rotation) * (position - t.translation)) / t.scale;
  }
  return position;
}

}  // namespace furrow::wrinkle

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

namespace {

// `position` is in the space of the first joint.
template <class Vector, class Joint>
Vector Carry(Vector position, const JointChains::Chain& chain, std::span<const Joint> local) {
  // lane_points-inl.h has the same order of operations, so that both give the same bits.
  for (const std::int16_t joint : chain.up) {
    const Joint& t = local[static_cast<std::size_t>(joint)];
    position = t.translation + t.rotation * (t.scale * position);
  }
  for (const std::int16_t joint : chain.down) {
    const Joint& t = local[static_cast<std::size_t>(joint)];
    position = (glm::conjugate(t.rotation) * (position - t.translation)) / t.scale;
  }
  return position;
}

}  // namespace

glm::vec3 JointChains::Evaluate(std::span<const Transform> local, int point) const {
  return Carry(chain(point).offset, chain(point), local);
}

glm::dvec3 JointChains::Evaluate(std::span<const PreciseTransform> local, int point) const {
  return Carry(glm::dvec3(chain(point).offset), chain(point), local);
}

}  // namespace furrow::wrinkle

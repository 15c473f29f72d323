// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "wrinkle/skeleton/joint_role.h"
#include "wrinkle/skeleton/skeleton.h"

// How two bodies stand at rest, seen through their joints' roles. Private to wrinkle/: what
// Retarget needs to know before it carries a pose.
namespace furrow::wrinkle {

// A skeleton whose joints have roles.
class Body {
 public:
  // `roles` one a joint, or empty; both must outlive this.
  Body(const Skeleton& skeleton, const JointRoles& roles);

  [[nodiscard]] const Skeleton& skeleton() const { return *skeleton_; }
  // The joints of that role, parents first.
  [[nodiscard]] std::span<const int> Chain(JointRole role) const;
  [[nodiscard]] int First(JointRole role) const;  // kNoJoint when there is none
  [[nodiscard]] int Last(JointRole role) const;
  [[nodiscard]] JointRole RoleOf(int joint) const;
  [[nodiscard]] glm::vec3 RestOrigin(int joint) const;  // model space
  // From the first joint of one role to that of another, at rest; nullopt without one of them, or
  // where they lie in one place.
  [[nodiscard]] std::optional<glm::vec3> RestSpan(JointRole from, JointRole to) const;

 private:
  const Skeleton* skeleton_;
  const JointRoles* roles_;
  std::array<std::vector<int>, kNumJointRoles> chains_;
};

// The turn by which `from` comes to point along `to`, the shortest way (for opposite directions any
// of them); neither has zero length.
[[nodiscard]] glm::quat Swing(const glm::vec3& from, const glm::vec3& to);

// The joint that `role`'s bone points at: the next one of a limb or finger, the middle finger of a
// hand; kNone for the trunk and for what ends a limb.
[[nodiscard]] JointRole BoneEnd(JointRole role);

// The turn, by quarters about the model axes, that makes `source` stand upright and face where
// `target` does. The identity where their hips, heads and sides cannot be told.
[[nodiscard]] glm::quat QuarterTurn(const Body& source, const Body& target);

// Model-space rotations of `target`'s joints in the stance that `source`, turned by `turn`, has at
// rest: arms, legs and fingers point the same way, palms face the same way, feet have the same
// heading and stay flat. The trunk and all else stand as in target's own rest pose: how a spine's
// joints lie in a body is the rig's matter and no pose.
[[nodiscard]] std::vector<glm::quat> AlignedStance(const Body& source, const Body& target,
                                                   const glm::quat& turn);

// Length of a stretched leg, from the height of the hips' joint to the last joint that both bodies
// have (the toes, else the foot); 0 where one of them has no legs. Mean of both sides.
[[nodiscard]] float LegLength(const Body& body, const Body& other);

// Up, as the body says it: of length 1 along one of the model axes; +Y where nothing tells.
[[nodiscard]] glm::vec3 UpAxis(const Body& body);

}  // namespace furrow::wrinkle

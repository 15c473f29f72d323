// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "wrinkle/skeleton/joint_role.h"
#include "wrinkle/skeleton/skeleton.h"

// The rest stances of two bodies, from the roles of their joints. Retarget prepares itself with it.
// Private to wrinkle/.
namespace furrow::wrinkle {

inline constexpr float kMinBoneLength = 1e-6f;  // shorter bones have no direction

// A skeleton with joint roles.
class Body {
 public:
  // `roles` has one entry per joint, or is empty. Both arguments outlive the body.
  Body(const Skeleton& skeleton, const JointRoles& roles);

  [[nodiscard]] const Skeleton& skeleton() const { return *skeleton_; }
  // The joints of that role, parents first.
  [[nodiscard]] std::span<const int> Chain(JointRole role) const;
  [[nodiscard]] int First(JointRole role) const;  // kNoJoint if there is none
  [[nodiscard]] int Last(JointRole role) const;
  [[nodiscard]] JointRole RoleOf(int joint) const;
  [[nodiscard]] glm::vec3 RestOrigin(int joint) const;  // model space
  // The vector at rest from the first joint of one role to the first joint of the other. nullopt if
  // one is missing, or if they lie in one place.
  [[nodiscard]] std::optional<glm::vec3> RestSpan(JointRole from, JointRole to) const;

 private:
  const Skeleton* skeleton_;
  const JointRoles* roles_;
  std::array<std::vector<int>, kNumJointRoles> chains_;
};

// The shortest turn from the direction `from` to the direction `to`; any of them for opposite
// directions. Precondition: neither has zero length.
[[nodiscard]] glm::quat Swing(const glm::vec3& from, const glm::vec3& to);

// The role at the end of `role`'s bone: the next joint of a limb or finger, and the middle finger
// for a hand. kNone for the trunk and for the last joint of a limb.
[[nodiscard]] JointRole BoneEnd(JointRole role);

// The direction away from the ends of all four limbs, if they point the same way at rest and the
// trunk does not: a body on four legs, whose trunk is level, or a person with hanging arms. A unit
// vector in model space. nullopt otherwise, and if a limb is unknown.
[[nodiscard]] std::optional<glm::vec3> UpOfLimbs(const Body& body);

// The turn, in steps of 90 degrees about the model axes, that makes `source` stand upright and face
// in `target`'s direction. The identity if hips, heads or sides are unknown.
[[nodiscard]] glm::quat QuarterTurn(const Body& source, const Body& target);

// Model-space rotations of `target`'s joints in the stance that `source`, turned by `turn`, has at
// rest: arms, legs and fingers point the same way, palms face the same way, feet have the same
// heading and stay flat. The trunk and all other joints keep target's own rest pose, because the
// position of spine joints in a body is a property of the rig, not of the pose.
[[nodiscard]] std::vector<glm::quat> AlignedStance(const Body& source, const Body& target,
                                                   const glm::quat& turn);

// The turn from the body's model space to Furrow's (+Y up, facing +Z), in quarter turns. nullopt if
// the trunk or both sides are unknown.
[[nodiscard]] std::optional<glm::quat> TurnOfAxes(const Body& body);

// The length of a stretched leg, from the height of the hips' joint to the last joint that both
// bodies have (the toes, or else the foot). Mean of both sides; 0 if one body has no legs.
[[nodiscard]] float LegLength(const Body& body, const Body& other);

// The body's up direction: a unit vector along one of the model axes; +Y if it is unknown.
[[nodiscard]] glm::vec3 UpAxis(const Body& body);

}  // namespace furrow::wrinkle

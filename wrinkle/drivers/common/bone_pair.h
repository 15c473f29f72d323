// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "wrinkle/drivers/common/bind_context.h"
#include "wrinkle/simd/lane_planner.h"

namespace furrow::wrinkle {

inline constexpr float kMaxBetaDegrees = 179.0f;  // at 180 a straight joint would be fully bent
// Drivers reject a hinge axis or a ball's forward direction within 6 degrees of the bone: such a
// direction turns the bone about itself. This is the sine of that angle.
inline constexpr float kLeastAcross = 0.1f;

// 1 / (1 + cos(beta)) of thesis 4.6. `beta_degrees` is the angle between the bones when the joint
// is fully flexed. 0 at 180 degrees, where straight and fully flexed are the same.
[[nodiscard]] float BendScale(float beta_degrees);

// The two bones that meet at a hinge or ball joint: the upper bone from `parent`'s origin to the
// joint's origin, the lower bone from there to its end. All positions are in the space of `parent`.
// Private to wrinkle/.
struct BonePair {
  int parent = kNoJoint;
  int joint = kNoJoint;
  int joint_point = 0;  // into the binding's JointChains
  int end_point = 0;

  // Unit directions away from the trunk; zero for a bone without length.
  [[nodiscard]] glm::vec3 Upper(std::span<const Transform> local, const JointChains& chains) const;
  [[nodiscard]] glm::vec3 Lower(std::span<const Transform> local, const JointChains& chains) const;
};

// Finds the joints of a hinge or ball driver and fills `pair`. An empty `end` means the joint's
// tail. `need_upper`: the upper bone must have a length. If BindOptions allow missing joints, sets
// `usable` to false and returns Ok where it otherwise fails: a joint is missing, or the driver
// cannot work on this skeleton.
[[nodiscard]] Status BindBonePair(std::string_view owner, const std::string& parent,
                                  const std::string& joint, const std::string& end, bool need_upper,
                                  BindContext* context, BonePair* pair, bool* usable);

// What bound hinges and balls have in common.
struct BoneEntry {
  int first_value = 0;
  BonePair bones;
};

// Up to sixteen hinges or balls, one per lane.
struct BoneBlock : Block {
  std::uint32_t joint_point = 0;  // into PointPlan::points
  std::uint32_t end_point = 0;
};

// Plans the points and values of up to sixteen hinges or balls.
void PlanBones(std::span<const BoneEntry> entries, std::size_t num_values, LanePlanner* planner,
               BoneBlock* block);

// Returns the function `length` for InBlocks(): it sorts drivers by the number of joints in the
// chain of their end point, so that chains of equal length share a block.
template <class Entry>
auto LengthOfBones(std::span<const Entry> entries, const JointChains& chains) {
  return [entries, &chains](int i) {
    const JointChains::Chain chain =
        chains.chain(entries[static_cast<std::size_t>(i)].bones.end_point);
    return std::pair(chain.down.size(), chain.up.size());
  };
}

}  // namespace furrow::wrinkle

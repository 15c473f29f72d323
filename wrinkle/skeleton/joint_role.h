// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace furrow::wrinkle {

// The part of a human body that a joint represents, independent of its name: the humanoid bones of
// VRM 1.0, which include the fingers. Left and right are the subject's.
//
// Several joints below one another may have the same role and form a chain, such as a neck of two
// joints.
enum class JointRole : std::uint8_t {
  kNone,
  kHips,
  kSpine,
  kChest,
  kUpperChest,
  kNeck,
  kHead,
  kJaw,
  kLeftEye,
  kLeftShoulder,
  kLeftUpperArm,
  kLeftLowerArm,
  kLeftHand,
  kLeftThumbMetacarpal,
  kLeftThumbProximal,
  kLeftThumbDistal,
  kLeftIndexProximal,
  kLeftIndexIntermediate,
  kLeftIndexDistal,
  kLeftMiddleProximal,
  kLeftMiddleIntermediate,
  kLeftMiddleDistal,
  kLeftRingProximal,
  kLeftRingIntermediate,
  kLeftRingDistal,
  kLeftLittleProximal,
  kLeftLittleIntermediate,
  kLeftLittleDistal,
  kLeftUpperLeg,
  kLeftLowerLeg,
  kLeftFoot,
  kLeftToes,
  kRightEye,
  kRightShoulder,
  kRightUpperArm,
  kRightLowerArm,
  kRightHand,
  kRightThumbMetacarpal,
  kRightThumbProximal,
  kRightThumbDistal,
  kRightIndexProximal,
  kRightIndexIntermediate,
  kRightIndexDistal,
  kRightMiddleProximal,
  kRightMiddleIntermediate,
  kRightMiddleDistal,
  kRightRingProximal,
  kRightRingIntermediate,
  kRightRingDistal,
  kRightLittleProximal,
  kRightLittleIntermediate,
  kRightLittleDistal,
  kRightUpperLeg,
  kRightLowerLeg,
  kRightFoot,
  kRightToes,
};
inline constexpr int kNumJointRoles = 56;  // with kNone

// The roles without which a body moves stiffly: hips, head, upper and lower arms and legs.
inline constexpr std::array kEssentialRoles = {
    JointRole::kHips,          JointRole::kHead,          JointRole::kLeftUpperArm,
    JointRole::kLeftLowerArm,  JointRole::kRightUpperArm, JointRole::kRightLowerArm,
    JointRole::kLeftUpperLeg,  JointRole::kLeftLowerLeg,  JointRole::kRightUpperLeg,
    JointRole::kRightLowerLeg,
};

// One role per joint, in the skeleton's order; empty: unknown.
using JointRoles = std::vector<JointRole>;

// VRM's spelling: "leftUpperArm"; "none" for kNone.
[[nodiscard]] std::string_view ToString(JointRole role);
// The role with exactly this name; nullopt if there is none.
[[nodiscard]] std::optional<JointRole> ParseJointRole(std::string_view name);

// The role above `role` in VRM's tree; kNone for the hips and kNone.
[[nodiscard]] JointRole ParentOf(JointRole role);
// The same role on the other side; roles in the middle of the body are their own mirror.
[[nodiscard]] JointRole MirrorOf(JointRole role);

// True for the joints of fingers; for the jaw and the eyes; for arms, hands, legs, feet and toes,
// without shoulders.
[[nodiscard]] bool IsFinger(JointRole role);
[[nodiscard]] bool IsOfFace(JointRole role);
[[nodiscard]] bool IsOfLimb(JointRole role);

}  // namespace furrow::wrinkle

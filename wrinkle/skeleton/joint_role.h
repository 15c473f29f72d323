// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace furrow::wrinkle {

// What a joint is in a human body, whatever it is called: VRM 1.0's humanoid bones, which name the
// fingers, too. Left and right are the subject's own.
//
// A role may be held by several joints, one below the other (a neck of two joints): a chain.
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

// One a joint, in the skeleton's order; empty: nothing is known.
using JointRoles = std::vector<JointRole>;

// "leftUpperArm", as VRM spells it; "none" for kNone.
[[nodiscard]] std::string_view ToString(JointRole role);
// The role of that exact name; nullopt when there is none.
[[nodiscard]] std::optional<JointRole> ParseJointRole(std::string_view name);

// The role above it in VRM's tree; kNone for the hips.
[[nodiscard]] JointRole ParentOf(JointRole role);
// The same role on the other side; the role itself in the middle of the body.
[[nodiscard]] JointRole MirrorOf(JointRole role);

}  // namespace furrow::wrinkle

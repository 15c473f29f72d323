// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/skeleton/joint_role.h"

#include <cstddef>

namespace furrow::wrinkle {
namespace {

using enum JointRole;

// Roles are numbered: the middle of the body, then the left side, then the right side in the same
// order. Mirroring is therefore an addition.
constexpr int kFirstLeft = static_cast<int>(kLeftEye);
constexpr int kFirstRight = static_cast<int>(kRightEye);
constexpr int kNumOfASide = kFirstRight - kFirstLeft;
static_assert(kFirstRight + kNumOfASide == kNumJointRoles);

constexpr std::array<std::string_view, kFirstLeft> kMiddle = {
    "none", "hips", "spine", "chest", "upperChest", "neck", "head", "jaw"};

struct SideRole {
  std::string_view left;
  std::string_view right;
  JointRole parent;  // of the left side
};

constexpr std::array<SideRole, kNumOfASide> kSides = {{
    {"leftEye", "rightEye", kHead},
    {"leftShoulder", "rightShoulder", kUpperChest},
    {"leftUpperArm", "rightUpperArm", kLeftShoulder},
    {"leftLowerArm", "rightLowerArm", kLeftUpperArm},
    {"leftHand", "rightHand", kLeftLowerArm},
    {"leftThumbMetacarpal", "rightThumbMetacarpal", kLeftHand},
    {"leftThumbProximal", "rightThumbProximal", kLeftThumbMetacarpal},
    {"leftThumbDistal", "rightThumbDistal", kLeftThumbProximal},
    {"leftIndexProximal", "rightIndexProximal", kLeftHand},
    {"leftIndexIntermediate", "rightIndexIntermediate", kLeftIndexProximal},
    {"leftIndexDistal", "rightIndexDistal", kLeftIndexIntermediate},
    {"leftMiddleProximal", "rightMiddleProximal", kLeftHand},
    {"leftMiddleIntermediate", "rightMiddleIntermediate", kLeftMiddleProximal},
    {"leftMiddleDistal", "rightMiddleDistal", kLeftMiddleIntermediate},
    {"leftRingProximal", "rightRingProximal", kLeftHand},
    {"leftRingIntermediate", "rightRingIntermediate", kLeftRingProximal},
    {"leftRingDistal", "rightRingDistal", kLeftRingIntermediate},
    {"leftLittleProximal", "rightLittleProximal", kLeftHand},
    {"leftLittleIntermediate", "rightLittleIntermediate", kLeftLittleProximal},
    {"leftLittleDistal", "rightLittleDistal", kLeftLittleIntermediate},
    {"leftUpperLeg", "rightUpperLeg", kHips},
    {"leftLowerLeg", "rightLowerLeg", kLeftUpperLeg},
    {"leftFoot", "rightFoot", kLeftLowerLeg},
    {"leftToes", "rightToes", kLeftFoot},
}};

constexpr std::array<JointRole, kFirstLeft> kMiddleParents = {kNone,  kNone,       kHips, kSpine,
                                                              kChest, kUpperChest, kNeck, kHead};

}  // namespace

std::string_view ToString(JointRole role) {
  const int i = static_cast<int>(role);
  if (i < kFirstLeft) return kMiddle[static_cast<std::size_t>(i)];
  if (i < kFirstRight) return kSides[static_cast<std::size_t>(i - kFirstLeft)].left;
  return kSides[static_cast<std::size_t>(i - kFirstRight)].right;
}

std::optional<JointRole> ParseJointRole(std::string_view name) {
  for (int i = 1; i < kNumJointRoles; ++i) {
    if (ToString(static_cast<JointRole>(i)) == name) return static_cast<JointRole>(i);
  }
  return std::nullopt;
}

JointRole ParentOf(JointRole role) {
  const int i = static_cast<int>(role);
  if (i < kFirstLeft) return kMiddleParents[static_cast<std::size_t>(i)];
  if (i < kFirstRight) return kSides[static_cast<std::size_t>(i - kFirstLeft)].parent;
  return MirrorOf(kSides[static_cast<std::size_t>(i - kFirstRight)].parent);
}

JointRole MirrorOf(JointRole role) {
  const int i = static_cast<int>(role);
  if (i < kFirstLeft) return role;
  return static_cast<JointRole>(i < kFirstRight ? i + kNumOfASide : i - kNumOfASide);
}

bool IsFinger(JointRole role) {
  const JointRole left = role >= kRightEye ? MirrorOf(role) : role;
  return left >= kLeftThumbMetacarpal && left <= kLeftLittleDistal;
}

bool IsOfFace(JointRole role) { return role == kJaw || role == kLeftEye || role == kRightEye; }

bool IsOfLimb(JointRole role) {
  const JointRole left = role >= kRightEye ? MirrorOf(role) : role;
  return (left >= kLeftUpperArm && left <= kLeftHand) || left >= kLeftUpperLeg;
}

}  // namespace furrow::wrinkle

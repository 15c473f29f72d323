// SPDX-License-Identifier: Apache-2.0
#include "protocol/mocap/humanoid.h"

#include <array>

namespace furrow::protocol::mocap {
namespace {

// Name, index of the parent, rest offset from the parent in metres (Y up, facing +Z) in a T-pose.
// Parents come first.
constexpr std::array<HumanoidJoint, kNumHumanoidJoints> kJoints = {{
    {"Hips", -1, {0.0f, 0.95f, 0.0f}},
    {"Spine", 0, {0.0f, 0.1f, 0.0f}},
    {"Chest", 1, {0.0f, 0.13f, 0.0f}},
    {"UpperChest", 2, {0.0f, 0.13f, 0.0f}},
    {"Neck", 3, {0.0f, 0.14f, 0.0f}},
    {"Head", 4, {0.0f, 0.09f, 0.01f}},
    {"Jaw", 5, {0.0f, 0.01f, 0.03f}},
    {"LeftEye", 5, {0.032f, 0.07f, 0.08f}},
    {"RightEye", 5, {-0.032f, 0.07f, 0.08f}},
    {"LeftShoulder", 3, {0.03f, 0.1f, 0.0f}},
    {"LeftUpperArm", 9, {0.12f, 0.0f, 0.0f}},
    {"LeftLowerArm", 10, {0.27f, 0.0f, 0.0f}},
    {"LeftHand", 11, {0.25f, 0.0f, 0.0f}},
    {"LeftThumbProximal", 12, {0.03f, -0.01f, 0.03f}},
    {"LeftThumbIntermediate", 13, {0.03f, 0.0f, 0.02f}},
    {"LeftThumbDistal", 14, {0.025f, 0.0f, 0.01f}},
    {"LeftIndexProximal", 12, {0.09f, 0.0f, 0.025f}},
    {"LeftIndexIntermediate", 16, {0.035f, 0.0f, 0.0f}},
    {"LeftIndexDistal", 17, {0.022f, 0.0f, 0.0f}},
    {"LeftMiddleProximal", 12, {0.09f, 0.0f, 0.003f}},
    {"LeftMiddleIntermediate", 19, {0.04f, 0.0f, 0.0f}},
    {"LeftMiddleDistal", 20, {0.026f, 0.0f, 0.0f}},
    {"LeftRingProximal", 12, {0.085f, 0.0f, -0.018f}},
    {"LeftRingIntermediate", 22, {0.037f, 0.0f, 0.0f}},
    {"LeftRingDistal", 23, {0.025f, 0.0f, 0.0f}},
    {"LeftLittleProximal", 12, {0.078f, 0.0f, -0.038f}},
    {"LeftLittleIntermediate", 25, {0.028f, 0.0f, 0.0f}},
    {"LeftLittleDistal", 26, {0.02f, 0.0f, 0.0f}},
    {"LeftUpperLeg", 0, {0.09f, -0.05f, 0.0f}},
    {"LeftLowerLeg", 28, {0.0f, -0.42f, 0.0f}},
    {"LeftFoot", 29, {0.0f, -0.41f, -0.02f}},
    {"LeftToes", 30, {0.0f, -0.06f, 0.13f}},
    {"RightShoulder", 3, {-0.03f, 0.1f, 0.0f}},
    {"RightUpperArm", 32, {-0.12f, 0.0f, 0.0f}},
    {"RightLowerArm", 33, {-0.27f, 0.0f, 0.0f}},
    {"RightHand", 34, {-0.25f, 0.0f, 0.0f}},
    {"RightThumbProximal", 35, {-0.03f, -0.01f, 0.03f}},
    {"RightThumbIntermediate", 36, {-0.03f, 0.0f, 0.02f}},
    {"RightThumbDistal", 37, {-0.025f, 0.0f, 0.01f}},
    {"RightIndexProximal", 35, {-0.09f, 0.0f, 0.025f}},
    {"RightIndexIntermediate", 39, {-0.035f, 0.0f, 0.0f}},
    {"RightIndexDistal", 40, {-0.022f, 0.0f, 0.0f}},
    {"RightMiddleProximal", 35, {-0.09f, 0.0f, 0.003f}},
    {"RightMiddleIntermediate", 42, {-0.04f, 0.0f, 0.0f}},
    {"RightMiddleDistal", 43, {-0.026f, 0.0f, 0.0f}},
    {"RightRingProximal", 35, {-0.085f, 0.0f, -0.018f}},
    {"RightRingIntermediate", 45, {-0.037f, 0.0f, 0.0f}},
    {"RightRingDistal", 46, {-0.025f, 0.0f, 0.0f}},
    {"RightLittleProximal", 35, {-0.078f, 0.0f, -0.038f}},
    {"RightLittleIntermediate", 48, {-0.028f, 0.0f, 0.0f}},
    {"RightLittleDistal", 49, {-0.02f, 0.0f, 0.0f}},
    {"RightUpperLeg", 0, {-0.09f, -0.05f, 0.0f}},
    {"RightLowerLeg", 51, {0.0f, -0.42f, 0.0f}},
    {"RightFoot", 52, {0.0f, -0.41f, -0.02f}},
    {"RightToes", 53, {0.0f, -0.06f, 0.13f}},
}};

}  // namespace

std::span<const HumanoidJoint> HumanoidJoints() { return kJoints; }

int FindHumanoidJoint(std::string_view name) {
  for (int i = 0; i < kNumHumanoidJoints; ++i) {
    if (kJoints[static_cast<std::size_t>(i)].name == name) return i;
  }
  return -1;
}

}  // namespace furrow::protocol::mocap

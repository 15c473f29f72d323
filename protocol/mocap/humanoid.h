// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

#include "protocol/messages/messages.h"

namespace furrow::protocol::mocap {

inline constexpr int kNumHumanoidJoints = 55;

// A joint of the humanoid skeleton of Unity and VRM, with the proportions of an average adult.
struct HumanoidJoint {
  std::string_view name;  // from Unity's HumanBodyBones
  int parent = -1;        // index of an earlier joint; -1 for Hips
  Vec3 rest_translation;  // local, metres: an adult of about 1.7 m in T-pose, left = +X
};

// The kNumHumanoidJoints joints, parents first. Valid for the life of the process.
[[nodiscard]] std::span<const HumanoidJoint> HumanoidJoints();
// Returns the index of the joint with exactly this name in HumanoidJoints(), or -1.
[[nodiscard]] int FindHumanoidJoint(std::string_view name);

}  // namespace furrow::protocol::mocap

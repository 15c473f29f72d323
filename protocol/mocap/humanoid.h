// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

#include "protocol/messages/messages.h"

namespace furrow::protocol::mocap {

inline constexpr int kNumHumanoidJoints = 55;

struct HumanoidJoint {
  std::string_view name;  // Unity's HumanBodyBones
  int parent = -1;        // index of an earlier one; -1 for Hips
  Vec3 rest_translation;  // local, metres: an adult of about 1.7 m in T-pose, left = +X
};

// Parents first.
[[nodiscard]] std::span<const HumanoidJoint> HumanoidJoints();
[[nodiscard]] int FindHumanoidJoint(std::string_view name);  // -1 when there is none

}  // namespace furrow::protocol::mocap

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "wrinkle/drivers/bind_context.h"

namespace furrow::wrinkle {

// The two bones that meet at a hinge or ball joint, seen from the upper one's joint (`parent`):
// from parent's origin to the joint's, and on to the lower bone's end. Private to wrinkle/.
struct BonePair {
  int parent = kNoJoint;
  int joint = kNoJoint;
  int joint_point = 0;  // into the binding's JointChains
  int end_point = 0;

  // Unit directions away from the trunk, parent's axes; zero where a bone has no length.
  [[nodiscard]] glm::vec3 Upper(std::span<const Transform> local, const JointChains& chains) const;
  [[nodiscard]] glm::vec3 Lower(std::span<const Transform> local, const JointChains& chains) const;
};

// Resolves the joints of a hinge or ball driver. `usable` false: something is missing and may be,
// or makes no sense on this skeleton (see BindContext::Unusable()). `end` empty: the joint's tail.
// `need_upper`: whether the upper bone must have a length.
[[nodiscard]] Status BindBonePair(std::string_view whose, const std::string& parent,
                                  const std::string& joint, const std::string& end, bool need_upper,
                                  BindContext* context, BonePair* pair, bool* usable);

}  // namespace furrow::wrinkle

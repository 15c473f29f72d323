// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <glm/vec3.hpp>

#include "wrinkle/skeleton/joint_role.h"
#include "wrinkle/skeleton/skeleton.h"

// What the hierarchy and the rest pose tell about a body, whatever the names of its joints.
namespace furrow::wrinkle {

// Determines the roles of joints: one fork with two legs and a spine, another with two arms and a
// neck, and the direction of the toes for the sides. The result is a guess that a person should
// check.
//
// One role per joint; empty if the hierarchy is not that of an upright body, such as a fox's.
[[nodiscard]] JointRoles RolesFromHierarchy(const Skeleton& skeleton);

// A body on two or four legs at rest.
struct BodyShape {
  int root = kNoJoint;
  int head = kNoJoint;      // the topmost joint of the neck, or the fork of the arms without a neck
  glm::vec3 up{0.0f};       // unit vector, model space: away from the feet
  bool is_upright = false;  // the trunk points up; false: on four legs
};

// Finds the body by the same forks. Both legs point the same way. They point away from the trunk,
// or the same way as the front legs. nullopt if the hierarchy tells neither.
[[nodiscard]] std::optional<BodyShape> FindBodyShape(const Skeleton& skeleton);

}  // namespace furrow::wrinkle

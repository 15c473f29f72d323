// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "gltf/scene/joints.h"
#include "gltf/write/builder.h"

namespace furrow::gltf {

[[nodiscard]] Builder::Json ToJson(const glm::vec3& v);
[[nodiscard]] Builder::Json ToJson(const glm::quat& q);  // x y z w

// A node with a name and a transform. Rotation and scale are left out if they are the default.
[[nodiscard]] Builder::Json NodeJson(const std::string& name, const Transform& local);

// Appends one node per joint to `nodes`, in order, with kTailExtra for joints that have a tail, and
// kRoleExtra for joints that have a role. `nodes` must be empty, so that a joint's index is its
// node. Appends the indices of the roots to `roots`.
void AddJointNodes(std::span<const Joint> joints, Builder::Json* nodes, Builder::Json* roots);

}  // namespace furrow::gltf

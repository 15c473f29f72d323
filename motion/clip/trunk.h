// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "wrinkle/skeleton/skeleton.h"

namespace furrow::motion {

// A joint that names a head, and its root; kNoJoint if there is none.
struct Trunk {
  int root = wrinkle::kNoJoint;
  int head = wrinkle::kNoJoint;
};

// Finds the first joint with "head" in its name, in any case. Nearly all skeletons have one.
[[nodiscard]] Trunk FindTrunk(const wrinkle::Skeleton& skeleton);

// How far the lowest joint at rest is below the root, along Y. Precondition: there is a trunk.
[[nodiscard]] float Reach(const wrinkle::Skeleton& skeleton, const Trunk& trunk);

[[nodiscard]] inline glm::vec3 OriginOf(std::span<const glm::mat4> model, int joint) {
  return glm::vec3(model[static_cast<std::size_t>(joint)][3]);
}

}  // namespace furrow::motion

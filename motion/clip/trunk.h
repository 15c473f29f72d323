// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "wrinkle/skeleton/skeleton.h"

namespace furrow::motion {

// A head, and the root of its skeleton; kNoJoint if there is none.
struct Trunk {
  int root = wrinkle::kNoJoint;
  int head = wrinkle::kNoJoint;
  // Away from the feet at rest; a unit vector, model space. Nullopt if no legs were found.
  std::optional<glm::vec3> up;
  bool on_four_legs = false;

  [[nodiscard]] bool has_head() const { return head != wrinkle::kNoJoint; }
};

// Finds legs, trunk and head from the hierarchy (wrinkle::FindBodyShape()). The head is then the
// first joint with "head" in its name, in any case, if there is one.
[[nodiscard]] Trunk FindTrunk(const wrinkle::Skeleton& skeleton);

// How far the lowest joint at rest is below the root, along Y. Precondition: there is a head.
[[nodiscard]] float Reach(const wrinkle::Skeleton& skeleton, const Trunk& trunk);

[[nodiscard]] inline glm::vec3 OriginOf(std::span<const glm::mat4> model, int joint) {
  return glm::vec3(model[static_cast<std::size_t>(joint)][3]);
}

}  // namespace furrow::motion

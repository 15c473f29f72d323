// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "character/generator/head_shape.h"

namespace furrow::character::generator {

// A lock of hair: where its middle runs from the root to the tip, and half its width at its widest.
// Head space, centimetres.
struct HairLock {
  std::vector<glm::vec3> path;
  float width = 0.5f;
};

// Grows the lock at `root`, a point of the scalp: short at the sides and combed back from the brow
// for a man, swept back to the nape for a woman; mixtures between them. `number` varies
// it.
[[nodiscard]] HairLock GrowLock(const HeadShape& shape, const glm::vec3& root, int number,
                                int sections);

}  // namespace furrow::character::generator

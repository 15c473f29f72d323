// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "authoring/generator/head/head_shape.h"

namespace furrow::authoring {

// A lock of hair: the points of its middle line from root to tip, the outward unit vector at each
// point, and half the width. Head space, centimetres.
struct HairLock {
  std::vector<glm::vec3> path;
  std::vector<glm::vec3> out;
  float width = 0.5f;
};

// How far a point of the scalp lies inside the hairline, centimetres; negative: bare skin. `p`:
// head space.
[[nodiscard]] float InsideHairline(const glm::vec3& p);

// Grows the lock with its root at `root`, a point of the scalp. A man's hair is short at the sides
// and combed back from a parting; a woman's is drawn back into a knot; values between are mixtures.
// `number` selects the variation. The path has `sections` + 1 points. It is empty where no hair
// grows (under the knot).
[[nodiscard]] HairLock GrowLock(const HeadShape& shape, const glm::vec3& root, int number,
                                int sections);

// The locks that form the knot at the back of the head; empty for a man.
[[nodiscard]] std::vector<HairLock> WindKnot(const HeadShape& shape, int sections);

}  // namespace furrow::authoring

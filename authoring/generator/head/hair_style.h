// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "authoring/generator/head/head_shape.h"

namespace furrow::authoring {

// A lock of hair, in head space, centimetres.
struct HairLock {
  std::vector<glm::vec3> path;  // the middle line, from root to tip
  std::vector<glm::vec3> out;   // unit vector away from the head, one per point of `path`
  float width = 0.5f;           // half the width of the lock
};

// How far the point `p` of the scalp lies inside the hairline, centimetres; negative: outside, on
// bare skin. `p`: head space, centimetres.
[[nodiscard]] float InsideHairline(const glm::vec3& p);

// Grows the lock with its root at `root`, a point of the scalp in head space, centimetres. Male
// hair (FaceParameters::sex 1) is short at the sides and combed back from a parting; female hair
// (-1) is drawn back into a knot; values in between blend. `number`: seed of the random variation
// of the lock. `sections` >= 1: the path has `sections` + 1 points. It is empty where no hair grows
// (under the knot).
[[nodiscard]] HairLock GrowLock(const HeadShape& shape, const glm::vec3& root, int number,
                                int sections);

// The locks that form the knot at the back of the head; empty for a male head. `sections` >= 1:
// every path has `sections` + 1 points.
[[nodiscard]] std::vector<HairLock> WindKnot(const HeadShape& shape, int sections);

}  // namespace furrow::authoring

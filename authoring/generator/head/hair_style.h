// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "authoring/generator/head/head_shape.h"

namespace furrow::authoring {

// A lock of hair: where its middle runs from the root to the tip, which way is out there (unit),
// and half its width. Head space, centimetres.
struct HairLock {
  std::vector<glm::vec3> path;
  std::vector<glm::vec3> out;
  float width = 0.5f;
};

// How far a point of the scalp lies inside the hairline, centimetres; negative: bare skin. `p`:
// head space.
[[nodiscard]] float InsideHairline(const glm::vec3& p);

// Grows the lock at `root`, a point of the scalp: short at the sides and combed back from a parting
// for a man, drawn back into a knot for a woman; mixtures between them. `number` varies it. The
// path has `sections` + 1 points; none where nothing grows (under the knot).
[[nodiscard]] HairLock GrowLock(const HeadShape& shape, const glm::vec3& root, int number,
                                int sections);

// The locks wound into the knot at the back of the head; none for a man.
[[nodiscard]] std::vector<HairLock> WindKnot(const HeadShape& shape, int sections);

}  // namespace furrow::authoring

// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace furrow::wrinkle {

// What remains of a wrinkle weight beside the opposed weight of a neighbouring region, as a factor
// in [0, 1]: smoothstep(-1/2, 1/2, (own - other) / (own + other)).
//
// - 1 where the other is at most a third of it, 0 where it is at most a third of the other, 1/2 at
//   a tie: the weaker is attenuated by their difference relative to their sum, so that a weight
//   without an opponent is never touched, however small.
// - The factors of a pair sum to 1, so at most one of the two stays above 1/2.
// - own * factor is continuous in both weights (also at 0, 0), hence in time.
// - Source: docs/ALGORITHM.md; the thesis leaves it open (6.2.3).
[[nodiscard]] float CongruenceFactor(float own, float other);

}  // namespace furrow::wrinkle

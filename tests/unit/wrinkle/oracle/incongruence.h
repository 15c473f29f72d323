// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace furrow::wrinkle {

// The factor in [0, 1] that the opposed weight of a neighbouring region leaves of a wrinkle weight:
// smoothstep(-1/2, 1/2, (own - other) / (own + other)).
//
// - 1 if `other` is at most a third of `own`, 0 if `own` is at most a third of `other`, 1/2 if both
//   are equal. The difference is relative to the sum, so an opponent of 0 changes nothing.
// - The factors of a pair sum to 1, so at most one of the two stays above 1/2.
// - own * factor is continuous in both weights (also at 0, 0), hence in time.
// - Source: docs/ALGORITHM.md; the thesis leaves it open (6.2.3).
[[nodiscard]] float CongruenceFactor(float own, float other);

}  // namespace furrow::wrinkle

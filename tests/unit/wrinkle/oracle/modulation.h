// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "wrinkle/rig/rig.h"

namespace furrow::wrinkle {

// Thesis 4.3: (1 - cos(pi x)) / 2. `x` in [0, 1] gives [0, 1] with zero slope at both ends.
[[nodiscard]] float CosineModulation(float x);

// Thesis 4.4 as printed: 2.62235 x - 4.87773 x^2 + 3.26168 x^3. Rises at 2.62 from 0, rests near
// x = 0.5, and leaves the range at its end: f(1) = 1.0063.
[[nodiscard]] float CubicModulation(float x);

// The modulated value, with `x` and the result clamped to [0, 1].
[[nodiscard]] float Modulate(Modulation modulation, float x);

}  // namespace furrow::wrinkle

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "wrinkle/weights/modulation_curve.h"

namespace furrow::wrinkle {

// Thesis 4.3: (1 - cos(pi x)) / 2. `x` in [0, 1] gives [0, 1] with zero slope at both ends.
[[nodiscard]] float CosineModulation(float x);

// Thesis 4.4 as printed: 2.62235 x - 4.87773 x^2 + 3.26168 x^3. Rises at 2.62 from 0, rests near
// x = 0.5, and leaves the range at its end: f(1) = 1.0063.
[[nodiscard]] float CubicModulation(float x);

// The monotone cubic through the points, in double: Hermite's basis, with Brodlie's form of the
// slopes. The first `y` before the first point, the last `y` after the last.
[[nodiscard]] double CurveModulation(std::span<const CurvePoint> points, double x);

// The modulated value, with `x` and the result clamped to [0, 1].
[[nodiscard]] float Modulate(const FeedModulation& modulation, float x);
[[nodiscard]] inline float Modulate(Modulation modulation, float x) {
  return Modulate({.modulation = modulation, .curve = {}}, x);
}

}  // namespace furrow::wrinkle

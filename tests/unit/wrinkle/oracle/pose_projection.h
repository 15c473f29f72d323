// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <glm/vec3.hpp>

namespace furrow::wrinkle {

// Control points stacked into one long vector: points of one driver, in one space and unit.
using StackedPoints = std::span<const glm::vec3>;

// In double: a Gram matrix of rounded products may not be positive definite.
[[nodiscard]] double Dot(StackedPoints a, StackedPoints b);

// |a - scale * b|^2, equally long.
[[nodiscard]] float SquaredDistance(StackedPoints a, StackedPoints b, float scale);

// d / dot(d, d) of displacement `d`, point by point; `squared_displacement` is that square.
// 0 where it is 0.
[[nodiscard]] glm::vec3 Projection(const glm::vec3& d, float squared_displacement);

// Thesis 4.1 with dot(d, d) in the denominator: how far along a displacement, given by its
// Projection(), the points have `moved`; 0 at rest, 1 at the reference pose, not clamped.
[[nodiscard]] float ProjectionAlong(StackedPoints moved, StackedPoints projection);

// exp(-perpendicular^2 / (2 falloff^2 |d|^2)); 1 where `falloff` is 0 (none).
[[nodiscard]] float Falloff(float squared_perpendicular, float squared_displacement, float falloff);

}  // namespace furrow::wrinkle

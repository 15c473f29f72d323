// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace furrow {

inline constexpr float kPi = 3.14159265358979f;
inline constexpr float kDegrees = kPi / 180.0f;  // radians per degree

// Clamps `x` to [0, 1]. NaN gives 0, so that no formula's result leaves the range.
[[nodiscard]] inline constexpr float Saturate(float x) {
  return x > 0.0f ? (x < 1.0f ? x : 1.0f) : 0.0f;
}

// GLSL's smoothstep: 0 for x <= from, 1 for x >= to, and t^2 (3 - 2 t) with t = (x - from) /
// (to - from) between them. Precondition: `from` < `to`.
[[nodiscard]] inline constexpr float Smoothstep(float from, float to, float x) {
  const float t = Saturate((x - from) / (to - from));
  return t * t * (3.0f - 2.0f * t);
}

}  // namespace furrow

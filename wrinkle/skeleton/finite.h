// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

// Tests that every number is finite, without branches: x * 0 is 0 for a finite x and NaN otherwise,
// so the sum of these products is 0 exactly if all numbers are finite. The sum cannot overflow.
namespace furrow::wrinkle {

[[nodiscard]] inline bool AllFinite(std::span<const float> values) {
  float zero = 0.0f;
  for (const float value : values) zero += value * 0.0f;
  return zero == 0.0f;
}

[[nodiscard]] inline bool AllFinite(const glm::vec3& v) {
  return v.x * 0.0f + v.y * 0.0f + v.z * 0.0f == 0.0f;
}

[[nodiscard]] inline bool AllFinite(const glm::quat& q) {
  return q.x * 0.0f + q.y * 0.0f + q.z * 0.0f + q.w * 0.0f == 0.0f;
}

[[nodiscard]] inline bool AllFinite(std::span<const glm::mat4> matrices) {
  glm::vec4 zero(0.0f);
  for (const glm::mat4& m : matrices) zero += m[0] * 0.0f + m[1] * 0.0f + m[2] * 0.0f + m[3] * 0.0f;
  return zero.x + zero.y + zero.z + zero.w == 0.0f;
}

}  // namespace furrow::wrinkle

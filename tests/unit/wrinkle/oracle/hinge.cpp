// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/wrinkle/oracle/hinge.h"

#include <cmath>

#include <glm/geometric.hpp>

#include "base/scalar.h"

namespace furrow::wrinkle {

float Bend(float cosine, float bend_scale) { return Saturate((1.0f - cosine) * bend_scale); }

float SignedBend(const glm::vec3& upper, const glm::vec3& lower, const glm::vec3& axis,
                 float bend_scale) {
  const glm::vec3 normal = glm::cross(upper, lower);
  const float sine = glm::length(normal);
  if (!(sine > kLeastSine)) return Bend(glm::dot(upper, lower), bend_scale);
  const float along_axis = glm::dot(normal, axis) / sine;
  return Bend(glm::dot(upper, lower), bend_scale) * Smoothstep(0.0f, kFullAlongAxis, along_axis);
}

}  // namespace furrow::wrinkle

// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/wrinkle/oracle/pose_projection.h"

#include <cmath>

#include <glm/geometric.hpp>

namespace furrow::wrinkle {

double Dot(StackedPoints a, StackedPoints b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += glm::dot(glm::dvec3(a[i]), glm::dvec3(b[i]));
  return sum;
}

float SquaredDistance(StackedPoints a, StackedPoints b, float scale) {
  float sum = 0.0f;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const glm::vec3 difference = a[i] - scale * b[i];
    sum += glm::dot(difference, difference);
  }
  return sum;
}

glm::vec3 Projection(const glm::vec3& d, float squared_displacement) {
  if (squared_displacement <= 0.0f) return glm::vec3(0.0f);
  return glm::dvec3(d) / double{squared_displacement};
}

// In single precision, like the points.
float ProjectionAlong(StackedPoints moved, StackedPoints projection) {
  float sum = 0.0f;
  for (std::size_t i = 0; i < moved.size(); ++i) sum += glm::dot(moved[i], projection[i]);
  return sum;
}

float Falloff(float squared_perpendicular, float squared_displacement, float falloff) {
  if (falloff <= 0.0f || squared_displacement <= 0.0f) return 1.0f;
  return std::exp(-squared_perpendicular / (2.0f * falloff * falloff * squared_displacement));
}

}  // namespace furrow::wrinkle

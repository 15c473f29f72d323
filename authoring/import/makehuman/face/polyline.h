// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <initializer_list>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "base/scalar.h"

namespace furrow::authoring {

// The distance of `p` from the polyline through `line`, which has at least two points.
[[nodiscard]] inline float DistanceToLine(const glm::vec3& p,
                                          std::initializer_list<glm::vec3> line) {
  float nearest = std::numeric_limits<float>::max();
  for (const glm::vec3* a = line.begin(); a + 1 < line.end(); ++a) {
    const glm::vec3 along = a[1] - a[0];
    const float t = std::clamp(glm::dot(p - a[0], along) / std::max(glm::dot(along, along), 1e-12f),
                               0.0f, 1.0f);
    nearest = std::min(nearest, glm::distance(p, a[0] + along * t));
  }
  return nearest;
}

// 1 up to the distance `inner`, 0 from the distance `outer` on, smooth in between.
[[nodiscard]] inline float FadeOut(float distance, float inner, float outer) {
  return Smoothstep(outer, inner, distance);
}

}  // namespace furrow::authoring

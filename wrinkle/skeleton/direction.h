// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "wrinkle/skeleton/skeleton.h"

namespace furrow::wrinkle {

inline constexpr float kLeastLength = 1e-12f;  // shorter vectors have no direction

// `v` scaled to unit length; zero if `v` is not longer than kLeastLength.
[[nodiscard]] inline glm::vec3 Direction(const glm::vec3& v) {
  const float length = glm::length(v);
  return length > kLeastLength ? v / length : glm::vec3(0.0f);
}

// The least cosine between directions that count as alike: 60 degrees.
inline constexpr float kLeastAlike = 0.5f;

// True if the cosine between two vectors is above `least`. False if one of them is zero.
[[nodiscard]] inline bool PointAlike(const glm::vec3& a, const glm::vec3& b,
                                     float least = kLeastAlike) {
  return glm::dot(a, b) > least * glm::length(a) * glm::length(b);
}

// Converts a direction from model axes in the rest pose to the axes of `joint`. kNoJoint: returns
// the direction unchanged.
[[nodiscard]] inline glm::vec3 ToJointAxes(const Skeleton& skeleton, int joint,
                                           const glm::vec3& direction) {
  if (joint == kNoJoint) return direction;
  return glm::conjugate(skeleton.rest_model_rotations()[joint]) * direction;
}

}  // namespace furrow::wrinkle

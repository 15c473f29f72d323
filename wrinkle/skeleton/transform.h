// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "wrinkle/skeleton/finite.h"

namespace furrow::wrinkle {

// Translation, rotation and scale of one joint; as a matrix T * R * S (glTF's order).
//
// Spaces are right-handed and Y up, a character faces +Z. Lengths are in the units of the
// skeleton's source (metres in our own characters); no wrinkle weight depends on them.
struct Transform {
  glm::vec3 translation{0.0f};
  glm::quat rotation{1.0f, 0.0f, 0.0f, 0.0f};  // unit; glm's constructor takes w first
  glm::vec3 scale{1.0f};
};

// The matrix T * R * S, which maps the joint's space to its parent's space.
[[nodiscard]] glm::mat4 ToMatrix(const Transform& transform);

// A Transform in double precision, for what is computed once, when a rig is bound.
struct PreciseTransform {
  PreciseTransform() = default;
  // The rotation is normalised again, in double precision.
  explicit PreciseTransform(const Transform& transform)
      : translation(transform.translation),
        rotation(glm::normalize(glm::dquat(transform.rotation))),
        scale(transform.scale) {}

  glm::dvec3 translation{0.0};
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
  glm::dvec3 scale{1.0};
};

[[nodiscard]] inline bool AllFinite(std::span<const Transform> transforms) {
  glm::vec3 zero(0.0f);
  glm::quat zero_rotation(0.0f, 0.0f, 0.0f, 0.0f);
  for (const Transform& transform : transforms) {
    zero += transform.translation * 0.0f + transform.scale * 0.0f;
    zero_rotation = zero_rotation + transform.rotation * 0.0f;
  }
  return AllFinite(zero) && AllFinite(zero_rotation);
}

// Every component is finite and the rotation's length is within 1e-3 of 1.
[[nodiscard]] bool IsValid(const Transform& transform);

}  // namespace furrow::wrinkle

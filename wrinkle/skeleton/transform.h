// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace furrow::wrinkle {

// Translation, rotation and scale of one joint; as a matrix T * R * S (glTF's order).
//
// Spaces are right-handed and Y up, a character faces +Z. Lengths are in the units of whoever made
// the skeleton (metres in our own characters); no wrinkle weight depends on them.
struct Transform {
  glm::vec3 translation{0.0f};
  glm::quat rotation{1.0f, 0.0f, 0.0f, 0.0f};  // unit; glm's constructor takes w first
  glm::vec3 scale{1.0f};
};

[[nodiscard]] glm::mat4 ToMatrix(const Transform& transform);

// Every component finite and the rotation's length within 1e-3 of 1.
[[nodiscard]] bool IsValid(const Transform& transform);

}  // namespace furrow::wrinkle

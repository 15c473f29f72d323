// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace furrow::gltf {

// A node's local transform: translation * rotation * scale. glTF is right-handed, Y up, in metres.
struct Transform {
  glm::vec3 translation{0.0f};
  glm::quat rotation{1.0f, 0.0f, 0.0f, 0.0f};  // unit; glm's constructor takes w first
  glm::vec3 scale{1.0f};
};

[[nodiscard]] glm::mat4 ToMatrix(const Transform& transform);

struct Decomposition {
  Transform transform;
  bool has_shear = false;  // two axes deviate from a right angle by more than 1e-3 (cosine)
  bool is_flat = false;    // an axis is shorter than 1e-9
};

// Splits a finite affine matrix into a transform.
//
// - A mirrored matrix (negative determinant) gets a negative scale.x.
// - A transform cannot express shear. The result then has the axes' lengths and a rotation near
//   theirs.
// - A flat axis keeps its length as scale; the other axes determine its direction.
[[nodiscard]] Decomposition Decompose(const glm::dmat4& matrix);

}  // namespace furrow::gltf

// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/skeleton/transform.h"

namespace furrow::wrinkle {

glm::mat4 ToMatrix(const Transform& transform) {
  glm::mat4 matrix = glm::mat4_cast(transform.rotation);
  matrix[0] *= transform.scale.x;
  matrix[1] *= transform.scale.y;
  matrix[2] *= transform.scale.z;
  matrix[3] = glm::vec4(transform.translation, 1.0f);
  return matrix;
}

bool IsValid(const Transform& transform) {
  if (!AllFinite(transform.translation) || !AllFinite(transform.scale)) return false;
  const float length = glm::length(transform.rotation);
  return length > 0.999f && length < 1.001f;  // false for NaN as well
}

}  // namespace furrow::wrinkle

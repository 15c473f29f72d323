// SPDX-License-Identifier: Apache-2.0
#include "gltf/scene/transform.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace furrow::gltf {
namespace {

// kFlat is a length in the file's units, kShear the cosine between two axes.
constexpr double kFlat = 1e-9;
constexpr double kShear = 1e-3;

// A unit vector across `unit`, from the axis that is far from parallel to it.
glm::dvec3 AnyPerpendicular(const glm::dvec3& unit) {
  const glm::dvec3 other = std::abs(unit.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  return glm::normalize(glm::cross(unit, other));
}

// Gives the axes that are zero a direction, so that the three span space.
void CompleteAxes(glm::dmat3* axes) {
  // A round may complete an axis that another one needs. Three rounds suffice for three axes.
  for (int round = 0; round < 3; ++round) {
    for (int i = 0; i < 3; ++i) {
      glm::dvec3& axis = (*axes)[i];
      const glm::dvec3& next = (*axes)[(i + 1) % 3];
      const glm::dvec3& last = (*axes)[(i + 2) % 3];
      if (axis != glm::dvec3(0.0)) continue;
      const glm::dvec3 cross = glm::cross(next, last);
      if (glm::length(cross) > 1e-6) {
        axis = glm::normalize(cross);
      } else if (next != glm::dvec3(0.0) || last != glm::dvec3(0.0)) {
        axis = AnyPerpendicular(next != glm::dvec3(0.0) ? next : last);
      } else {
        axis[i] = 1.0;
      }
    }
  }
}

}  // namespace

glm::mat4 ToMatrix(const Transform& transform) {
  glm::mat4 matrix = glm::mat4_cast(transform.rotation);
  for (int i = 0; i < 3; ++i) matrix[i] *= transform.scale[i];
  matrix[3] = glm::vec4(transform.translation, 1.0f);
  return matrix;
}

Decomposition Decompose(const glm::dmat4& matrix) {
  Decomposition result;
  glm::dmat3 axes(matrix);
  result.transform.translation = glm::vec3(matrix[3]);
  for (int i = 0; i < 3; ++i) {
    const double length = glm::length(axes[i]);
    result.transform.scale[i] = static_cast<float>(length);
    result.is_flat = result.is_flat || length < kFlat;
    axes[i] = length < kFlat ? glm::dvec3(0.0) : axes[i] / length;
  }
  const double shear =
      std::max({std::abs(glm::dot(axes[0], axes[1])), std::abs(glm::dot(axes[0], axes[2])),
                std::abs(glm::dot(axes[1], axes[2]))});
  result.has_shear = shear > kShear;
  if (result.is_flat) CompleteAxes(&axes);
  // A mirrored matrix has no rotation. A negative scale of one axis carries the mirroring.
  if (glm::determinant(axes) < 0.0) {
    result.transform.scale.x = -result.transform.scale.x;
    axes[0] = -axes[0];
  }
  // quat_cast expects orthogonal axes. With shear its result is not a unit and may even vanish.
  const glm::dquat rotation = glm::quat_cast(axes);
  const double length = glm::length(rotation);
  if (length > 1e-6) result.transform.rotation = glm::quat(rotation / length);
  return result;
}

}  // namespace furrow::gltf

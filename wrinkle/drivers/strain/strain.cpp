// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/drivers/strain/strain.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace furrow::wrinkle {
namespace {

constexpr float kLeastShape = 1e-6f;  // area over the longest edge's square
constexpr float kLeastSine = 0.01f;   // of the angle between a direction and the normal

float SquareOfPositive(double x) { return x > 0.0 ? static_cast<float>(x * x) : 0.0f; }

// (cos, sin) of half the angle in [-pi, pi] with this cosine and sine. The larger of the two
// results is computed first, so that no digits are lost.
glm::dvec2 HalfAngle(double cosine, double sine) {
  if (cosine >= 0.0) {
    const double c = std::sqrt(0.5 * (1.0 + cosine));
    return {c, 0.5 * sine / c};
  }
  const double s = std::copysign(std::sqrt(0.5 * (1.0 - cosine)), sine);
  return {0.5 * sine / s, s};
}

// The unit projection of `direction` into the plane across `normal`; along `edge` if it has none.
glm::vec3 AxisAlong(const glm::vec3& direction, const glm::vec3& normal, const glm::vec3& edge) {
  const glm::vec3 across = direction - glm::dot(direction, normal) * normal;
  const bool lies_in_plane = glm::length(across) > kLeastSine * glm::length(direction);
  return glm::normalize(lies_in_plane ? across : edge);
}

}  // namespace

std::optional<RestTriangle> MakeRestTriangle(const glm::vec3& a, const glm::vec3& b,
                                             const glm::vec3& c, const glm::vec3& direction) {
  const glm::vec3 edges[] = {b - a, c - a, c - b};
  float longest_square = 0.0f;
  for (const glm::vec3& edge : edges) {
    longest_square = std::max(longest_square, glm::dot(edge, edge));
  }
  const glm::vec3 cross = glm::cross(edges[0], edges[1]);
  const float twice_area = glm::length(cross);
  // Relative to the edges, so that the test works in any unit. The negation also rejects NaN.
  if (!(0.5f * twice_area > kLeastShape * longest_square) || !std::isfinite(longest_square)) {
    return std::nullopt;
  }
  RestTriangle rest;
  rest.area = 0.5f * twice_area;
  rest.axes.normal = cross / twice_area;
  rest.axes.x = AxisAlong(direction, rest.axes.normal, edges[0]);
  rest.axes.y = glm::cross(rest.axes.normal, rest.axes.x);
  const auto in_axes = [&](const glm::vec3& edge) {
    return glm::vec2(glm::dot(edge, rest.axes.x), glm::dot(edge, rest.axes.y));
  };
  rest.inverse_edges = glm::inverse(glm::mat2(in_axes(edges[0]), in_axes(edges[1])));
  return rest;
}

PrincipalStretches Principal(const CauchyGreen& tensor) {
  // In double: for small strains, mean and radius nearly cancel in the smallest stretch.
  const double mean = 0.5 * (double{tensor.xx} + double{tensor.yy});
  const double difference = 0.5 * (double{tensor.xx} - double{tensor.yy});
  const double shear = tensor.xy;
  const double radius = std::sqrt(difference * difference + shear * shear);
  if (!std::isfinite(mean + radius)) return {};
  PrincipalStretches result;
  result.largest = static_cast<float>(std::sqrt(mean + radius));
  result.smallest = static_cast<float>(std::sqrt(std::max(mean - radius, 0.0)));
  if (radius > 0.0) {
    // 2 phi of the largest stretch is the angle of (difference, shear).
    const glm::dvec2 largest = HalfAngle(difference / radius, shear / radius);
    result.largest_direction = largest;
    result.smallest_direction = {-largest.y, largest.x};
  }
  return result;
}

glm::vec3 ToRestSpace(const SurfaceAxes& axes, const glm::vec2& direction) {
  return direction.x * axes.x + direction.y * axes.y;
}

glm::vec3 ToPosedSpace(const DeformationGradient& f, const glm::vec2& direction) {
  const glm::vec3 image = direction.x * f.x + direction.y * f.y;
  const float length = glm::length(image);
  return length > 0.0f ? image / length : glm::vec3(0.0f);
}

CompressionShares ShareCompression(const PrincipalStretches& stretches) {
  // `less` is the compression that both principal directions share. It has no direction, so each
  // share gets a quarter. The excess is split by the squares of cos(2 phi) and sin(2 phi), which
  // sum to 1.
  const float more = std::max(0.0f, 1.0f - stretches.smallest);
  const float less = std::max(0.0f, 1.0f - stretches.largest);
  const glm::dvec2 d = stretches.smallest_direction;
  const double cosine = d.x * d.x - d.y * d.y;  // of 2 phi
  const double sine = 2.0 * d.x * d.y;
  const float excess = more - less;
  const float even = 0.25f * less;
  return {.compression = more,
          .along = excess * SquareOfPositive(cosine) + even,
          .across = excess * SquareOfPositive(-cosine) + even,
          .diagonal_left = excess * SquareOfPositive(sine) + even,
          .diagonal_right = excess * SquareOfPositive(-sine) + even};
}

}  // namespace furrow::wrinkle

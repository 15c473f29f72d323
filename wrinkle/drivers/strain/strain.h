// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace furrow::wrinkle {

// In-plane strain of a surface triangle: how the cloth or skin between three points is stretched
// and squeezed when the points move. A triangle can only turn, stretch and shear in its own plane,
// so a 2x2 tensor in axes fixed to the *rest* surface says all of it, whatever the pose's own space
// is.
//
// - Lengths are in any unit, the same at rest and posed; stretches are ratios (posed over rest
// length).
// - Nothing here depends on a rigid motion of the posed triangle, nor on its being mirrored.
// - Source: the right Cauchy-Green tensor C = F^T F of continuum mechanics (Bonet and Wood,
// Nonlinear
//   Continuum Mechanics, 2008, 4.5); its eigenvalues are the squared principal stretches.

// Orthonormal axes in the plane of a rest triangle, right-handed with its normal (counter-clockwise
// from outside): seen from outside, y lies a quarter turn to the left of x.
struct SurfaceAxes {
  glm::vec3 x{1.0f, 0.0f, 0.0f};
  glm::vec3 y{0.0f, 1.0f, 0.0f};
  glm::vec3 normal{0.0f, 0.0f, 1.0f};
};

// A triangle at rest, ready to be compared with any number of poses.
struct RestTriangle {
  SurfaceAxes axes;
  float area = 0.0f;
  glm::mat2 inverse_edges{1.0f};  // of the matrix whose columns are b - a and c - a in the axes
};

// What one unit of length along each rest axis has become: the columns of the 3x2 deformation
// gradient F, in the space of the posed points.
struct DeformationGradient {
  glm::vec3 x{1.0f, 0.0f, 0.0f};
  glm::vec3 y{0.0f, 1.0f, 0.0f};
};

// The right Cauchy-Green tensor F^T F in the rest axes; the identity at rest. Such tensors in
// common axes may be averaged: that averages the squared lengths.
struct CauchyGreen {
  float xx = 1.0f;
  float xy = 0.0f;
  float yy = 1.0f;
};

// The polar form of a surface strain.
struct PrincipalStretches {
  float largest = 1.0f;
  float smallest = 1.0f;  // >= 0; 1 - smallest is the principal compression where it is below 1
  // Unit directions in the rest axes, up to sign. Where both stretches are the same every direction
  // is a principal one, and these are the axes y and x.
  glm::vec2 largest_direction{0.0f, 1.0f};
  glm::vec2 smallest_direction{1.0f, 0.0f};
};

// The rest triangle a, b, c with its x axis along `direction` as far as it lies in the plane; where
// `direction` has nothing in it (within 0.6 degrees of the normal), along the edge from a to b.
//
// None for a degenerate triangle: an area not above 1e-6 of its longest edge squared (a sliver
// thinner than a needle, a point, a non-finite corner), whose strain would be noise.
[[nodiscard]] std::optional<RestTriangle> MakeRestTriangle(const glm::vec3& a, const glm::vec3& b,
                                                           const glm::vec3& c,
                                                           const glm::vec3& direction);

// F of the triangle posed at a, b, c. The posed triangle may be degenerate.
[[nodiscard]] inline DeformationGradient Deform(const RestTriangle& rest, const glm::vec3& a,
                                                const glm::vec3& b, const glm::vec3& c) {
  const glm::vec3 u = b - a;
  const glm::vec3 v = c - a;
  const glm::mat2& m = rest.inverse_edges;
  return {.x = u * m[0][0] + v * m[0][1], .y = u * m[1][0] + v * m[1][1]};
}

[[nodiscard]] inline CauchyGreen RightCauchyGreen(const DeformationGradient& f) {
  return {.xx = glm::dot(f.x, f.x), .xy = glm::dot(f.x, f.y), .yy = glm::dot(f.y, f.y)};
}

// Closed form. A tensor that is not finite gives the identity's stretches.
[[nodiscard]] PrincipalStretches Principal(const CauchyGreen& tensor);

// A direction in the rest axes as a vector of the rest triangle's space, and as the unit vector
// that it becomes in the pose (zero where F squeezes it to nothing).
[[nodiscard]] glm::vec3 ToRestSpace(const SurfaceAxes& axes, const glm::vec2& direction);
[[nodiscard]] glm::vec3 ToPosedSpace(const DeformationGradient& f, const glm::vec2& direction);

// The principal compression of a strain, shared out by its direction: what lets one place fold
// along or across.
//
// - `compression` = max(0, 1 - smallest stretch). The shares are >= 0 and sum to it.
// - `along`, `across`: compressed along or across the x axis (so that folds run across or along
// it);
//   `diagonal_left`, `diagonal_right`: along the line that, seen from outside, leans 45 degrees to
//   the left or the right of it.
// - With compressions c1 >= c2 and c1's angle phi from x, along gets
//   (c1 - c2) max(0, cos 2 phi)^2 + c2 / 4, and so on by quarter turns of 2 phi: the excess goes by
//   direction, an even squeeze to all alike. C1 in phi, continuous where c1 = c2 has no direction.
struct CompressionShares {
  float compression = 0.0f;
  float along = 0.0f;
  float across = 0.0f;
  float diagonal_left = 0.0f;
  float diagonal_right = 0.0f;
};
[[nodiscard]] CompressionShares ShareCompression(const PrincipalStretches& stretches);

}  // namespace furrow::wrinkle

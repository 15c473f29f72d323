// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace furrow::wrinkle {

// In-plane strain of a surface triangle: how the cloth or skin between three points is stretched
// and compressed when the points move. A triangle can only turn, stretch and shear in its own
// plane, so a 2x2 tensor in axes fixed to the *rest* surface describes its strain completely, in
// any pose space.
//
// - Lengths are in any unit, the same at rest and posed. Stretches are ratios, posed over rest
//   length.
// - Rigid motions and mirroring of the posed triangle change nothing.
// - Source: the right Cauchy-Green tensor C = F^T F of continuum mechanics (Bonet and Wood,
//   Nonlinear Continuum Mechanics, 2008, 4.5). Its eigenvalues are the squared principal
//   stretches.

// Orthonormal axes in the plane of a rest triangle, right-handed with its normal (counter-clockwise
// from outside): seen from outside, y lies a quarter turn to the left of x.
struct SurfaceAxes {
  glm::vec3 x{1.0f, 0.0f, 0.0f};
  glm::vec3 y{0.0f, 1.0f, 0.0f};
  glm::vec3 normal{0.0f, 0.0f, 1.0f};
};

// A triangle at rest, prepared for comparison with poses.
struct RestTriangle {
  SurfaceAxes axes;
  float area = 0.0f;
  glm::mat2 inverse_edges{1.0f};  // of the matrix with the columns b - a and c - a in the axes
};

// The images of the unit vectors along the rest axes: the columns of the 3x2 deformation gradient
// F, in the space of the posed points.
struct DeformationGradient {
  glm::vec3 x{1.0f, 0.0f, 0.0f};
  glm::vec3 y{0.0f, 1.0f, 0.0f};
};

// The right Cauchy-Green tensor F^T F in the rest axes; the identity at rest. Averaging tensors in
// common axes averages the squared lengths.
struct CauchyGreen {
  float xx = 1.0f;
  float xy = 0.0f;
  float yy = 1.0f;
};

// The polar form of a surface strain.
struct PrincipalStretches {
  float largest = 1.0f;
  float smallest = 1.0f;  // >= 0; 1 - smallest is the principal compression where it is below 1
  // Unit directions in the rest axes, up to sign. If both stretches are equal, every direction is
  // principal, and these are the axes y and x.
  glm::vec2 largest_direction{0.0f, 1.0f};
  glm::vec2 smallest_direction{1.0f, 0.0f};
};

// The rest triangle a, b, c. Its x axis is the projection of `direction` into the plane, or the
// edge from a to b if `direction` is within 0.6 degrees of the normal.
//
// nullopt for a degenerate triangle, since its strain would be noise: its area is not above 1e-6 of
// its longest edge squared, or a corner is not finite.
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

// The tensor F^T F of a deformation gradient.
[[nodiscard]] inline CauchyGreen RightCauchyGreen(const DeformationGradient& f) {
  return {.xx = glm::dot(f.x, f.x), .xy = glm::dot(f.x, f.y), .yy = glm::dot(f.y, f.y)};
}

// The principal stretches of a tensor: square roots of its eigenvalues, in closed form. A tensor
// that is not finite gives the stretches of the identity (1).
[[nodiscard]] PrincipalStretches Principal(const CauchyGreen& tensor);

// Converts a direction in the rest axes to a vector in the rest triangle's space, and to a unit
// vector in the pose's space (zero if F maps it to zero).
[[nodiscard]] glm::vec3 ToRestSpace(const SurfaceAxes& axes, const glm::vec2& direction);
[[nodiscard]] glm::vec3 ToPosedSpace(const DeformationGradient& f, const glm::vec2& direction);

// The principal compression of a strain, divided by direction, so that one place can fold along or
// across.
//
// - `compression` = max(0, 1 - smallest stretch). The shares are >= 0 and sum to it.
// - `along`, `across`: compression along or across the x axis; folds then run across or along it.
//   `diagonal_left`, `diagonal_right`: compression along the line 45 degrees to the left or right
//   of the x axis, as seen from outside.
// - With compressions c1 >= c2 and c1's angle phi from x, along gets
//   (c1 - c2) max(0, cos 2 phi)^2 + c2 / 4, and the others the same with 2 phi turned by
//   quarter turns. An even compression goes to all shares equally. C1 in phi; continuous at c1 =
//   c2.
struct CompressionShares {
  float compression = 0.0f;
  float along = 0.0f;
  float across = 0.0f;
  float diagonal_left = 0.0f;
  float diagonal_right = 0.0f;
};
[[nodiscard]] CompressionShares ShareCompression(const PrincipalStretches& stretches);

}  // namespace furrow::wrinkle

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace furrow::render {

using UvTriangle = std::array<glm::vec2, 3>;  // the UVs of a triangle's corners

// A texel near a triangle, and the point of the triangle nearest to the texel's centre.
struct UvTexel {
  std::size_t index = 0;          // row by row, from (0, 0)
  glm::vec3 shares{0.0f};         // barycentric coordinates of the point; they sum to 1
  float distance_squared = 0.0f;  // squared distance in texels; 0: the centre is inside
};

// Calls `visit` for each texel with its centre within `reach` texels of the triangle. The texture
// has `size` texels and repeats outside [0, 1].
void ForTexels(const UvTriangle& triangle, glm::ivec2 size, float reach,
               const std::function<void(const UvTexel&)>& visit);

// Returns false if one of the triangles, or all together, cover so much of the texture that they
// must overlap, which would take ForTexels() too long, or if a corner is not finite. Files can
// contain such triangles.
[[nodiscard]] bool IsAtlas(std::span<const UvTriangle> triangles);

}  // namespace furrow::render

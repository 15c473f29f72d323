// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace furrow::render {

using UvTriangle = std::array<glm::vec2, 3>;

// Where the centre of a texel lies in a triangle, or which of the triangle's points is nearest.
struct UvTexel {
  std::size_t index = 0;      // row after row, from (0, 0)
  glm::vec3 shares{0.0f};     // of the corners; they sum to 1
  float away_squared = 0.0f;  // texels; 0: within
};

// Calls `visit` for each texel of a texture of `size` texels, which repeats, whose centre lies
// within `reach` texels of a triangle.
void ForTexels(const UvTriangle& triangle, glm::ivec2 size, float reach,
               const std::function<void(const UvTexel&)>& visit);

// Whether no triangle, and not all of them together, go over so much of a texture that they must
// lie on each other: what comes from a file may. False for corners that are no numbers.
[[nodiscard]] bool IsAtlas(std::span<const UvTriangle> triangles);

}  // namespace furrow::render

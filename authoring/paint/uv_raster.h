// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "character/character.h"

namespace furrow::character::paint {

// A texel that a mesh covers, and where on the surface its centre lies (model space, rest pose).
struct Texel {
  int x = 0;
  int y = 0;                   // rows from the top, as in Picture
  glm::vec3 position{0.0f};    // metres
  glm::vec3 normal{0.0f};      // unit
  glm::vec3 tangent{0.0f};     // unit, across `normal`
  glm::vec3 bitangent{0.0f};   // cross(normal, tangent) * handedness: green of a normal map
  std::uint32_t triangle = 0;  // of the mesh: its indices start at 3 * triangle
  glm::vec3 corners{0.0f};     // barycentric, of the triangle's three vertices
};

// The texels of a width x height picture whose centres lie in a triangle of `mesh` in UV space,
// each once (the first triangle wins where UVs overlap), row by row.
//
// Painting by position instead of by UV is what keeps a stroke whole across UV seams: fill a
// picture from the texels, then Dilate() it.
// - UVs outside [0, 1) wrap, as the sampler would.
// - `overlaps` (may be null) is set to how many texels lie well inside more than one triangle.
[[nodiscard]] std::vector<Texel> RasterizeUv(const Mesh& mesh, int width, int height,
                                             std::int64_t* overlaps = nullptr);

// Grows what was painted at `texels` over the uncovered texels around them, so that filtering and
// mip levels near a UV seam find paint and not background. `passes`: how many texels far.
void Dilate(Picture* picture, const std::vector<Texel>& texels, int passes);

}  // namespace furrow::character::paint

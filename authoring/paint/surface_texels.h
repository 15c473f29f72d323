// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "character/character.h"

namespace furrow::authoring {

// A texel that a mesh covers, and the surface point at its centre (model space, rest pose).
struct SurfaceTexel {
  int x = 0;                   // column from the left
  int y = 0;                   // row from the top
  glm::vec3 position{0.0f};    // metres
  glm::vec3 normal{0.0f};      // unit
  glm::vec3 tangent{0.0f};     // unit, across `normal`
  glm::vec3 bitangent{0.0f};   // cross(normal, tangent) * handedness; green of a normal map
  std::uint32_t triangle = 0;  // index of the triangle in the mesh
  glm::vec3 corners{0.0f};     // barycentric coordinates in the triangle
};

// The texels of a width x height picture with centres inside a triangle of `mesh` in UV space, row
// by row. Each texel appears once; if UVs overlap, the first triangle is used.
//
// Painting by position instead of UV keeps features continuous across UV seams: fill a picture from
// the texels, then Dilate() it.
// - UVs outside [0, 1) wrap around like the sampler.
// - `overlaps` (may be null) receives the number of texels well inside more than one triangle.
[[nodiscard]] std::vector<SurfaceTexel> RasterizeSurface(const character::Mesh& mesh, int width,
                                                         int height,
                                                         std::int64_t* overlaps = nullptr);

}  // namespace furrow::authoring

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "character/character.h"

namespace furrow::render {

// A mesh as tessellation patches that height maps can displace without cracks.
//
// At a UV seam, two places in the texture are one place of the surface, and their heights differ
// slightly. Each edge and corner therefore has one owner, and all triangles that meet there use the
// owner's position, normal and UV ("dominant edges" and "dominant corners", Castaño 2008). The
// border of a mesh is not displaced, because adjacent meshes would not move with it.
struct DisplacementPatches {
  // Vertices per patch: the triangle's three corners; for each edge i, from corner i to the next,
  // the two vertices of its owner; for each corner, its owner.
  static constexpr int kCorners = 12;
  std::vector<std::uint32_t> indices;  // kCorners per triangle, indices of the mesh's vertices
  std::vector<float> shares;           // per vertex: 0 on the mesh's border, else 1
  float metres_per_uv = 1.0f;          // square root of (surface area / area in UV)
};

// Makes the patches of a mesh. Vertices that character::WeldVertices() merges, such as those of a
// UV seam, count as one point of the surface.
[[nodiscard]] DisplacementPatches MakeDisplacementPatches(const character::Mesh& mesh);

}  // namespace furrow::render

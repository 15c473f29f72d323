// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "character/character.h"

namespace furrow::render {

// A mesh as patches that can be displaced by a height map without a crack.
//
// At a UV seam two places of the atlas are one place of the surface, and their heights are never
// quite the same. So every edge and every corner has an owner: one triangle's edge, one vertex,
// whose place, normal and UV all triangles that meet there take (dominant edges and corners,
// Castaño 2008). Where a mesh ends, what lies against it is not displaced with it, so neither is
// the border.
struct DisplacementPatches {
  // A triangle's own corners; the owners of its edges' ends, edge i from corner i to the next;
  // the owners of its corners.
  static constexpr int kCorners = 12;
  std::vector<std::uint32_t> indices;  // kCorners a triangle, into the mesh's vertices
  std::vector<float> shares;           // one a vertex: 0 on the mesh's border, else 1
  float metres_per_uv = 1.0f;          // root of the mesh's surface over its surface in the atlas
};

// Vertices are the same point where character::WeldVertices() says so.
[[nodiscard]] DisplacementPatches MakeDisplacementPatches(const character::Mesh& mesh);

}  // namespace furrow::render

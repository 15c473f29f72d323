// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "character/character.h"

namespace furrow::render {

// A mesh with fewer triangles, for who is small in the picture, and for shadows.
struct MeshLevel {
  std::vector<std::uint32_t> indices;  // into the mesh's own vertices
  float error = 0.0f;                  // metres that the surface in its rest pose is off by (RMS)
};

// What becomes of edges that have one triangle. Meshes may share such a border, as a head and a
// body of two materials do, and must keep it then, since each is simplified by itself; strips of
// hair are hardly anything else, and nothing goes on beyond theirs.
enum class Borders { kStay, kDrawnIn };

// The mesh itself, then each level with two thirds of the triangles of the one before, as long as
// that can be had within 15 mm.
//
// Edges are collapsed onto one of their ends, the cheapest first by the quadric error metric
// (Garland and Heckbert 1997), so vertices keep their UV, normal, skin weights and masks. What lies
// on a UV seam or an edge of the shading stays, a border is at most drawn in along itself, which
// leaves its corners where they are, and no triangle turns over.
[[nodiscard]] std::vector<MeshLevel> MakeMeshLevels(const character::Mesh& mesh, Borders borders);

}  // namespace furrow::render

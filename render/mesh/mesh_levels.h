// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "character/character.h"

namespace furrow::render {

// A simplified mesh, for subjects that are small in the picture and for shadows.
struct MeshLevel {
  std::vector<std::uint32_t> indices;  // indices of the original mesh's vertices
  // RMS distance from the original surface in the rest pose, and the largest distance that a morph
  // target at weight 1 adds; metres.
  float error = 0.0f;
};

// Treatment of border edges, which belong to one triangle only. Meshes can share a border, for
// example a head and a body of two materials. Each mesh is simplified on its own, so shared borders
// must be kept. Hair strips consist mostly of borders, and no other mesh adjoins them.
enum class Borders { kKeep, kSimplify };

// Returns the mesh itself and then levels of detail, each with two thirds of the triangles of the
// level before. Stops where the error would exceed 15 mm.
//
// The simplifier collapses each edge onto one of its end points, in the order of the quadric error
// metric (Garland and Heckbert 1997). Remaining vertices therefore keep their UV, normal, skin
// weights, morph targets and masks. Vertices that a morph target moves otherwise than their
// neighbours stay until the error admits it, so that a distant face still moves (MorphError).
// Vertices on a UV seam or a shading seam do not move. Border vertices only move
// along a straight border, which keeps its corners. No triangle flips.
[[nodiscard]] std::vector<MeshLevel> MakeMeshLevels(const character::Mesh& mesh, Borders borders);

}  // namespace furrow::render

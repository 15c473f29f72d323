// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include <glm/vec2.hpp>

#include "character/character.h"

namespace furrow::authoring {

// Faults of the UVs of meshes that share one atlas. Wrinkle maps, masks and other painted textures
// require that every point of the surface has a texel that no other point uses.
struct UvReport {
  // Two triangles that share texels, and a shared place (UV, v down).
  struct Overlap {
    int meshes[2] = {-1, -1};  // into Character::meshes; may be equal
    int triangles[2] = {-1, -1};
    glm::vec2 uv{0.0f};
  };
  int triangles = 0;
  int islands = 0;  // connected pieces (vertices with the same position and UV are the same)
  int degenerate_triangles = 0;    // without area on the surface; never drawn, so they need no UVs
  int unmapped_triangles = 0;      // with area on the surface, but none in the atlas
  int outside_triangles = 0;       // with a corner outside [0, 1], where the sampler wraps around
  float covered = 0.0f;            // fraction of the atlas under at least one triangle, [0, 1]
  float overlapping = 0.0f;        // fraction of the covered area under several triangles, [0, 1]
  std::optional<Overlap> example;  // the first overlap found

  // True if no triangle with an area has UVs.
  [[nodiscard]] bool no_uvs() const {
    return unmapped_triangles > 0 && unmapped_triangles == triangles - degenerate_triangles;
  }
};

// The largest overlap that counts as a rounding error where islands touch: a fraction of the
// covered area, as UvReport::overlapping.
inline constexpr float kTolerableUvOverlap = 1e-3f;

// Checks `meshes` (indices into character.meshes) as one atlas, at `size` x `size` sample points.
//
// - Shared edges are exact: corners are rounded to 1/256 of a sample, and a sample on the edge of
//   two triangles belongs to one of them (the top-left rule of rasterisers).
// - UVs wrap around like a sampler. The work is bounded for any input: the check stops after 64
//   visits per sample and reports what it has found.
[[nodiscard]] UvReport CheckUvs(const character::Character& character, std::span<const int> meshes,
                                int size = 1024);

}  // namespace furrow::authoring

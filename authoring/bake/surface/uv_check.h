// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include <glm/vec2.hpp>

#include "character/character.h"

namespace furrow::character::bake {

// Whether meshes that share one picture give every place of their surface texels of its own: what a
// wrinkle map, a mask or any painted texture needs.
struct UvReport {
  // Two triangles on the same texels, and where (UV, v down).
  struct Overlap {
    int meshes[2] = {-1, -1};  // into Character::meshes; may be the same one
    int triangles[2] = {-1, -1};
    glm::vec2 uv{0.0f};
  };
  int triangles = 0;
  int islands = 0;                 // pieces whose triangles share vertices (place and UV)
  int degenerate_triangles = 0;    // no area on the surface: never drawn, so they need no UVs
  int unmapped_triangles = 0;      // an area on the surface, none in the picture
  int outside_triangles = 0;       // a corner outside [0, 1], where a sampler wraps round
  float covered = 0.0f;            // share of the picture under at least one triangle, [0, 1]
  float overlapping = 0.0f;        // share of that under more than one, [0, 1]
  std::optional<Overlap> example;  // of the overlaps, the first one met

  // No triangle with an area has UVs.
  [[nodiscard]] bool no_uvs() const {
    return unmapped_triangles > 0 && unmapped_triangles == triangles - degenerate_triangles;
  }
};

// Overlaps smaller than this share of the covered area are rounding where islands touch.
inline constexpr float kTolerableUvOverlap = 1e-3f;

// Looks at `meshes` (indices into character.meshes) as one atlas of `size` x `size` samples.
//
// - Exact about shared edges: corners are rounded to 1/256 of a sample, and a sample on the edge of
//   two triangles belongs to one of them (the rasteriser's top-left rule).
// - Wraps round as a sampler does. Work is bounded, whatever the UVs are: after 64 looks at every
//   sample it gives up, and what it has found counts.
[[nodiscard]] UvReport CheckUvs(const Character& character, std::span<const int> meshes,
                                int size = 1024);

}  // namespace furrow::character::bake

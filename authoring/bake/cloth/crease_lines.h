// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "authoring/bake/cloth/crease_walk.h"
#include "authoring/bake/surface/fine_mesh.h"

namespace furrow::authoring {

// A crest of cloth, as a line on the surface at rest.
struct Crease {
  struct Point {
    glm::vec3 place{0.0f};
    glm::vec3 normal{0.0f};  // of the surface
    glm::vec3 along{0.0f};   // unit vector to the next point
    float excess = 0.0f;
    float laid = 0.0f;  // the excess for which the crease was laid
    float spacing = 0.0f;
    float left = 0.0f;  // half the distance to the next crease on the side of cross(normal, along),
    float right = 0.0f;     // and on the other side, metres
    float strength = 1.0f;  // multiplier for depth, [0, 1]: varies, and is 0 at loose ends
  };
  std::vector<Point> points;
};

struct CreaseOptions {
  float least = 0.03f;     // excess below which no crease goes on
  float start = 0.045f;    // excess from which a crease may begin
  float nearest = 1.0f;    // distance that a new crease keeps from others, in spacings
  float variation = 0.3f;  // of the spacing, [0, 0.5]
  float shortest = 1.5f;   // in spacings
  float longest = 5.0f;    // in spacings
  std::uint32_t seed = 1;
};

// Lays creases over a field, from the strongest excess on: each runs along the field both ways
// until the excess ends, it meets another crease, or it is as long as it may be. Neighbours lie
// about a spacing apart. A crease that runs into another at a small angle joins it. Creases that
// are short or alone are left out.
//
// `excess`: what the points report, one per vertex, averaged along each crease. Where it is less
// than the field's, the creases are those of a deeper fold, and fade where it ends.
[[nodiscard]] std::vector<Crease> LayCreases(const FineMesh& mesh, const CreaseField& field,
                                             std::span<const float> excess,
                                             const CreaseOptions& options);

}  // namespace furrow::authoring

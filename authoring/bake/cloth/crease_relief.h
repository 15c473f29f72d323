// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "authoring/bake/cloth/crease_lines.h"
#include "authoring/bake/surface/fine_mesh.h"

namespace furrow::authoring {

struct ReliefOptions {
  float height = 0.9f;    // multiplier for sqrt(w hidden)
  float steepest = 1.5f;  // slope that no crest exceeds
  float highest = 0.4f;   // in spacings
  float narrow = 0.34f;   // half width of a shallow crest, in spacings
};

// The height of a crest of width `w` that hides the length `hidden`, metres: a cosine of that width
// and length is (2 / pi) sqrt(w hidden) high. No flank becomes steeper than `steepest`; where
// little is hidden, than 0.6 times that. No crest is higher than its share of `spacing`, from
// crease to crease.
[[nodiscard]] float CrestHeight(float w, float hidden, float spacing, const ReliefOptions& options);

// The heights of creases at the vertices of `mesh`, metres, >= 0. Shallow crests are round, between
// flat cloth. Deep ones are broad, and meet in V-shaped valleys.
[[nodiscard]] std::vector<float> DrawCreases(const FineMesh& mesh, std::span<const Crease> creases,
                                             const ReliefOptions& options);

}  // namespace furrow::authoring

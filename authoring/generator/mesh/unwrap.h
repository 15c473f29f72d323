// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <glm/vec2.hpp>

#include "authoring/generator/mesh/quad_net.h"

namespace furrow::authoring {

// Lays every panel flat with as little stretch and shear as it allows, in metres, starting from the
// uv that the corners have: as rigid as possible, by turns a rotation for each triangle and a
// least-squares fit to all (Liu and others, "A local/global approach to mesh parameterization",
// 2008). The mesh of a panel must be a disk: cut open along its seams.
void FlattenPanels(QuadNet* net);

// Where a panel lies in the atlas: atlas uv = place + scale * (panel uv in metres).
struct PanelPlace {
  glm::vec2 place{0.0f};
  float scale = 1.0f;  // alike for all
};

// Places the flat panels in the unit square, none overlapping, as large as rows of their bounding
// boxes allow, `margin` apart and from the edges (fractions of the square). Sets the corners' uv.
[[nodiscard]] std::vector<PanelPlace> PackPanels(float margin, QuadNet* net);

}  // namespace furrow::authoring

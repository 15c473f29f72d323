// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <glm/vec2.hpp>

#include "authoring/generator/mesh/quad_net.h"

namespace furrow::authoring {

// Flattens every panel with as little stretch and shear as possible, in metres, starting from the
// corners' UVs. The method is as-rigid-as-possible: it alternates a rotation per triangle with a
// least-squares fit (Liu et al., "A local/global approach to mesh parameterization", 2008).
// Precondition: the mesh of each panel is a disk.
void FlattenPanels(QuadNet* net);

// The place of a panel in the atlas: atlas uv = place + scale * (panel uv in metres).
struct PanelPlace {
  glm::vec2 place{0.0f};
  float scale = 1.0f;  // the same for all panels
};

// Places the flat panels in the unit square without overlap, as large as rows of their bounding
// boxes allow. Panels keep a distance of `margin` from each other and from the edges (fraction of
// the square). Sets the corners' UVs.
[[nodiscard]] std::vector<PanelPlace> PackPanels(float margin, QuadNet* net);

}  // namespace furrow::authoring

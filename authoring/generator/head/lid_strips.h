// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "authoring/generator/head/head_grid.h"
#include "authoring/generator/head/head_mesh.h"
#include "authoring/generator/head/head_shape.h"

// Strips that lie along the lids and move with them, in model space and the rest pose.
namespace furrow::authoring {

// The edge of a lid on the skin, from the inner to the outer corner, in head space. `side`: +1 for
// the subject's left, -1 for the right.
[[nodiscard]] std::vector<glm::vec3> LidEdge(const HeadGrid& grid, float side, bool upper);

// The tear lines: the strip of liquid between each lower lid and its eyeball, which reflects the
// lamps as one line. It moves with the lid.
[[nodiscard]] HeadMesh MakeTears(const HeadShape& shape = DefaultHead());

// The soft shadows that lids and lashes cast on the eyeballs: a shell in front of each eyeball, of
// a strip along each lid. v of a UV runs from 0.25, where the least light passes, to 0.75 at the
// strips' free edges, for PaintLidShade().
[[nodiscard]] HeadMesh MakeLidShades(const HeadShape& shape = DefaultHead());

}  // namespace furrow::authoring

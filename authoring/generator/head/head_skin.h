// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "authoring/generator/head/head_grid.h"
#include "authoring/generator/head/head_mesh.h"
#include "authoring/generator/head/head_shape.h"

namespace furrow::authoring {

// Face, neck, lids, inside of the mouth and ears in one atlas: the head's grid above, the ears
// below. `level` as in HeadGrid.
[[nodiscard]] HeadMesh MakeHeadSkin(const HeadShape& shape = DefaultHead(),
                                    int level = kDefaultLevel);

}  // namespace furrow::authoring

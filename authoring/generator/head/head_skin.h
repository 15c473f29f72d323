// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "authoring/generator/head/head_grid.h"
#include "authoring/generator/head/head_mesh.h"
#include "authoring/generator/head/head_shape.h"

namespace furrow::authoring {

// Makes the skin of a head: face, neck, lids, inside of the mouth, and ears. One UV atlas holds the
// head above and the ears below. `level`: level of detail, kCoarsestLevel to kFinestLevel.
[[nodiscard]] HeadMesh MakeHeadSkin(const HeadShape& shape = DefaultHead(),
                                    int level = kDefaultLevel);

}  // namespace furrow::authoring

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "authoring/generator/body/body_shape.h"
#include "authoring/generator/mesh/quad_net.h"

namespace furrow::authoring {

// Makes a shoe in the rest pose, with its influences. `side`: +1 left, -1 right. The upper is panel
// `panel`, the sole panel `panel` + 1.
[[nodiscard]] QuadNet MakeShoe(const BodyShape& shape, float side, int panel);

// Makes the belt (panel `panel`) and its buckle (panel `panel` + 1), around the waist of the
// trousers, in the rest pose.
[[nodiscard]] QuadNet MakeBelt(const BodyShape& shape, int panel);

}  // namespace furrow::authoring

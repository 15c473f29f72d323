// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "authoring/generator/body/body_shape.h"
#include "authoring/generator/mesh/quad_net.h"

namespace furrow::authoring {

// A shoe (`side` +1: left) with its influences, in rest: the upper is `panel`, the sole `panel`
// + 1.
[[nodiscard]] QuadNet MakeShoe(const BodyShape& shape, float side, int panel);

// The belt (`panel`) with its buckle (`panel` + 1) round the waist of the trousers.
[[nodiscard]] QuadNet MakeBelt(const BodyShape& shape, int panel);

}  // namespace furrow::authoring

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "authoring/generator/body/body_shape.h"
#include "authoring/generator/mesh/quad_net.h"

namespace furrow::authoring {

// A shoe at rest with its influences. `side`: +1 left, -1 right. The upper is `panel`, the sole
// `panel` + 1.
[[nodiscard]] QuadNet MakeShoe(const BodyShape& shape, float side, int panel);

// The belt (`panel`) and its buckle (`panel` + 1), around the waist of the trousers.
[[nodiscard]] QuadNet MakeBelt(const BodyShape& shape, int panel);

}  // namespace furrow::authoring

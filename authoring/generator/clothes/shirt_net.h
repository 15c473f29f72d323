// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "authoring/generator/body/body_shape.h"
#include "authoring/generator/mesh/quad_net.h"

namespace furrow::authoring {

// Makes a tucked-in shirt with collar and influences, with the arms hanging 30 degrees away from
// the sides (the modelling pose of `shape`). Trunk and sleeves are one surface with seams at the
// armholes, at the sides and along the inside of the arms.
[[nodiscard]] QuadNet MakeShirt(const BodyShape& shape);

}  // namespace furrow::authoring

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "authoring/generator/body/body_shape.h"
#include "authoring/generator/mesh/quad_net.h"

namespace furrow::authoring {

// Makes trousers with their influences, in the modelling pose of `shape` (a T-pose with lowered
// arms). Each leg is one panel from the hem to the waist, with seams along the inside of
// the leg and the middle of front and back.
[[nodiscard]] QuadNet MakeTrousers(const BodyShape& shape);

}  // namespace furrow::authoring

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "authoring/generator/body/body_shape.h"
#include "authoring/generator/mesh/quad_net.h"

namespace furrow::authoring {

// A tucked-in shirt with its influences, in the modelling pose (see BodyShape). Trunk and sleeves
// are one surface with seams at the armholes, at the sides and along the inside of the arms. The
// collar (collar_net.h) stands on the neckline.
[[nodiscard]] QuadNet MakeShirt(const BodyShape& shape);

}  // namespace furrow::authoring

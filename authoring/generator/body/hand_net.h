// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "authoring/generator/mesh/quad_net.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::authoring {

// A hand of rest (`side` +1: left) with its influences, stretched out with the palm down: fingers
// and thumb grow out of one surface. `panel` takes the back of the hand, `panel` + 1 the palm; they
// meet along the sides of the hand and the fingers. `level` as in BodyParameters.
[[nodiscard]] QuadNet MakeHand(const wrinkle::Skeleton& skeleton, float side, int panel, int level);

}  // namespace furrow::authoring

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "authoring/generator/mesh/quad_net.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::authoring {

// A stretched hand at rest, palm down, with its influences. Fingers and thumb are one surface with
// the palm. `side`: +1 left, -1 right. The back of the hand is `panel`, the palm `panel` + 1; they
// meet along the sides of hand and fingers. `level` as in BodyParameters.
[[nodiscard]] QuadNet MakeHand(const wrinkle::Skeleton& skeleton, float side, int panel, int level);

}  // namespace furrow::authoring

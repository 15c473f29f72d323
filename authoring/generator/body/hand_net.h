// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "authoring/generator/mesh/quad_net.h"
#include "wrinkle/skeleton/skeleton.h"

namespace furrow::authoring {

// Makes a stretched hand in the rest pose, palm down, with its influences. Fingers, thumb and palm
// are one surface. `side`: +1 left, -1 right. The back of the hand is panel `panel`, the palm panel
// `panel` + 1; they meet along the sides of hand and fingers. `level`: number of subdivisions, each
// of which splits every quad into four, >= 0.
[[nodiscard]] QuadNet MakeHand(const wrinkle::Skeleton& skeleton, float side, int panel, int level);

}  // namespace furrow::authoring

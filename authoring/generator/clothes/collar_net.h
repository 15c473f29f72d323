// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "authoring/generator/mesh/quad_net.h"
#include "authoring/generator/mesh/solid.h"

namespace furrow::authoring {

// Adds the collar of a shirt to `net`. `neckline`: points of `net` that run once around the neck,
// counter-clockwise from above, starting at the middle of the front. The collar's leaf lies on the
// solid `shirt`.
void AddCollar(const Solid& shirt, const std::vector<int>& neckline, QuadNet* net);

}  // namespace furrow::authoring

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>

#include "wrinkle/rig/rig.h"

namespace furrow::wrinkle {

// The names of all joints that a rig reads: the anchor and the joints of reference poses and
// drivers.
[[nodiscard]] std::set<std::string> JointsOf(const Rig& rig);

// A warning about pose drivers that have no anchor, and whose rig has none: they measure in model
// space, so every move of the body changes their values. Empty if there are none.
[[nodiscard]] std::string WarningOfModelSpace(const Rig& rig);

}  // namespace furrow::wrinkle

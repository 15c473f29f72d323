// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>

#include "wrinkle/rig/rig.h"

namespace furrow::wrinkle {

// The names of all joints that a rig reads: the anchor and the joints of reference poses and
// drivers.
[[nodiscard]] std::set<std::string> JointsOf(const Rig& rig);

}  // namespace furrow::wrinkle

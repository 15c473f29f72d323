// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>

#include "wrinkle/rig/rig.h"

namespace furrow::wrinkle {

// The names of all joints that a rig reads: its anchor, its reference poses' and its drivers'.
[[nodiscard]] std::set<std::string> JointsOf(const Rig& rig);

}  // namespace furrow::wrinkle

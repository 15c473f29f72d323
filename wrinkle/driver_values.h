// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "wrinkle/rig.h"

namespace furrow::wrinkle {

// The names of a driver's values, in their order: "flexed", "extended" for a hinge; "front",
// "back", "left", "right" for a ball; "twist_left", "twist_right" for a twist; "value" for a blend
// shape; and for a pose driver those that the rig gives.
[[nodiscard]] std::vector<std::string> DriverValueNames(const Driver& driver);

}  // namespace furrow::wrinkle

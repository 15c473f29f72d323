// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "wrinkle/rig/rig.h"

namespace furrow::wrinkle {

// The names of a driver's values, in their order: "flexed", "extended" for a hinge; "front",
// "back", "left", "right" for a ball; "twist_left", "twist_right" for a twist; "value" for a blend
// shape; and for a pose driver those that the rig gives.
[[nodiscard]] std::vector<std::string> DriverValueNames(const Driver& driver);

// Whether a driver whose values begin at `first_value` has a place in `driver_values`: a level of
// detail cuts them off behind a driver.
[[nodiscard]] inline bool Reaches(std::span<const float> driver_values, int first_value) {
  return static_cast<std::size_t>(first_value) < driver_values.size();
}

}  // namespace furrow::wrinkle

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "wrinkle/drivers/driver.h"

namespace furrow::wrinkle {

// The names of a driver's values, in their order. A pose driver's names come from the rig; the
// other kinds have fixed names (DriverValueNames() of drivers/<kind>/<kind>_fields.h).
[[nodiscard]] std::vector<std::string> DriverValueNames(const Driver& driver);

// The value of a hinge, a ball or a twist at an angle, in [0, 1]. `degrees`: the bend from straight
// towards the value's side, or the twist towards it, [0, 180]. Nothing for other kinds, whose
// values have no angle. The values rise or fall with the angle: ValueAtAngle() of
// drivers/<kind>/<kind>_fields.h has the kind's formula.
[[nodiscard]] std::optional<float> DriverValueAtAngle(const Driver& driver, std::string_view value,
                                                      float degrees);

}  // namespace furrow::wrinkle

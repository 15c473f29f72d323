// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "wrinkle/drivers/driver.h"

namespace furrow::wrinkle {

// The names of a driver's values, in their order. A pose driver's names come from the rig; the
// other kinds have fixed names (DriverValueNames() of drivers/<kind>/<kind>_fields.h).
[[nodiscard]] std::vector<std::string> DriverValueNames(const Driver& driver);

}  // namespace furrow::wrinkle

// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/rig/driver_values.h"

namespace furrow::wrinkle {

std::vector<std::string> DriverValueNames(const Driver& driver) {
  return VisitFields(driver, [](const auto& fields) { return DriverValueNames(fields); });
}

}  // namespace furrow::wrinkle

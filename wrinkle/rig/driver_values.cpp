// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/rig/driver_values.h"

namespace furrow::wrinkle {

std::vector<std::string> DriverValueNames(const Driver& driver) {
  return VisitFields(driver, [](const auto& fields) { return DriverValueNames(fields); });
}

std::optional<float> DriverValueAtAngle(const Driver& driver, std::string_view value,
                                        float degrees) {
  return VisitFields(driver, [&](const auto& fields) -> std::optional<float> {
    if constexpr (requires { ValueAtAngle(fields, value, degrees); }) {
      return ValueAtAngle(fields, value, degrees);
    } else {
      return std::nullopt;
    }
  });
}

}  // namespace furrow::wrinkle

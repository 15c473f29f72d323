// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "wrinkle/rig.h"
#include "wrinkle/status.h"

namespace furrow::character {

// What a rig may hold at most; far above any real one.
inline constexpr std::size_t kMaxReferencePoses = 1024;
inline constexpr std::size_t kMaxRigDrivers = 1024;
inline constexpr std::size_t kMaxRegions = 256;
inline constexpr std::size_t kMaxWrinkleMaps = 16;
inline constexpr std::size_t kMaxExports = 4096;

// Everything that can be said of a rig without a skeleton: names unique and well-formed, references
// that lead somewhere, numbers finite and in range. The error's `where` is the field as a path:
// "drivers[3].hinge.beta_degrees".
[[nodiscard]] Status CheckRig(const wrinkle::Rig& rig);

// The names of a driver's values, in the order of its values: "flexed" and "extended" for a hinge.
[[nodiscard]] std::vector<std::string> DriverValueNames(const wrinkle::Driver& driver);

}  // namespace furrow::character

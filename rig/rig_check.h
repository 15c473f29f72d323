// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "base/status.h"
#include "wrinkle/rig/rig.h"

namespace furrow::character {

inline constexpr std::size_t kMaxExports =
    4096;  // names; the other limits: wrinkle/rig/rig_check.h

// Everything that can be said of a rig without a skeleton: wrinkle::CheckRigFields(), references
// that lead somewhere, names of files that stay in their folders. The error's `where` is the field
// as a path: "drivers[3].hinge.beta_degrees".
[[nodiscard]] Status CheckRig(const wrinkle::Rig& rig);

}  // namespace furrow::character

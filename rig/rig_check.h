// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "base/status.h"
#include "wrinkle/rig/rig.h"

namespace furrow::rig {

// The largest number of exported names. wrinkle/rig/rig_check.h has the other limits.
inline constexpr std::size_t kMaxExports = 4096;

// Checks everything that needs no skeleton: the fields (wrinkle::CheckRigFields()), references
// between fields, and file names, which must not leave their folders. The error's `where` is the
// path of the field: "drivers[3].hinge.beta_degrees".
[[nodiscard]] Status CheckRig(const wrinkle::Rig& rig);

}  // namespace furrow::rig

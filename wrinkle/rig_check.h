// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "wrinkle/rig.h"
#include "wrinkle/status.h"

namespace furrow::wrinkle {

inline constexpr int kMaxWeights = 4096;          // regions times their maps
inline constexpr float kMaxBetaDegrees = 179.0f;  // of a hinge or ball: beyond, straight is flexed

// What RigBinding::Create() asks of a rig before it looks at a skeleton: names unique and not
// empty, counts within limits, every number finite and in its range (stated in rig.h).
//
// Errors: kInvalidArgument, kNonFinite and kLimit, naming the driver or region and the field.
// References between drivers, poses, maps and regions are checked where they are resolved.
[[nodiscard]] Status CheckRigNumbers(const Rig& rig);

}  // namespace furrow::wrinkle

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "wrinkle/skeleton/pose.h"
#include "wrinkle/solver/rig_binding.h"

namespace furrow::wrinkle {

// The values of a binding's first `num_drivers` drivers, driver by driver without SIMD; the other
// values are 0.
[[nodiscard]] std::vector<float> EvaluateDriversPlainly(const RigBinding& binding,
                                                        const LocalPose& pose,
                                                        std::size_t num_drivers);

}  // namespace furrow::wrinkle

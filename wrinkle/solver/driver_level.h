// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "wrinkle/solver/solver.h"

namespace furrow::wrinkle {

// The level of detail (SubjectSolver::set_num_drivers) that some outputs need: so many of the rig's
// drivers, in its order, give them as all drivers would. 0 where none is named. Indices are those
// of weight_names(), or of driver_value_names().
[[nodiscard]] std::size_t DriversOfWeights(const RigBinding& binding,
                                           std::span<const std::uint32_t> weights);
[[nodiscard]] std::size_t DriversOfValues(const RigBinding& binding,
                                          std::span<const std::uint32_t> driver_values);

}  // namespace furrow::wrinkle

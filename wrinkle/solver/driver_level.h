// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "wrinkle/solver/rig_binding.h"

namespace furrow::wrinkle {

// The lowest level of detail (SubjectSolver::set_num_drivers()) at which the given outputs are the
// same as with all drivers, to the bit. 0 for no outputs. Indices refer to weight_names() and to
// driver_value_names().
[[nodiscard]] std::size_t DriversOfWeights(const RigBinding& binding,
                                           std::span<const std::uint32_t> weights);
[[nodiscard]] std::size_t DriversOfValues(const RigBinding& binding,
                                          std::span<const std::uint32_t> driver_values);

}  // namespace furrow::wrinkle

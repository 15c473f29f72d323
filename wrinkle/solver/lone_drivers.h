// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace furrow::wrinkle {

struct BindingData;

// The nnls and strain drivers of one subject, which are not evaluated side by side, from the points
// that the batch has left in `scratch` (LanePlan) to values there. Private to wrinkle/.
void EvaluateLoneDrivers(const BindingData& data, std::size_t num_values, float* scratch);

}  // namespace furrow::wrinkle

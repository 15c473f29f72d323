// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace furrow::report {

// Returns the median of `samples`: the middle one, or the mean of the middle two. Precondition: at
// least one sample.
[[nodiscard]] double Median(std::vector<double> samples);

}  // namespace furrow::report

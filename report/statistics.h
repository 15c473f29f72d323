// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace furrow::report {

// Median of at least one sample. For an even number of samples, the mean of the middle two.
[[nodiscard]] double Median(std::vector<double> samples);

}  // namespace furrow::report

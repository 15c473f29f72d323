// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace furrow::report {

// Of at least one sample; of an even number, the mean of the middle two.
[[nodiscard]] double Median(std::vector<double> samples);

}  // namespace furrow::report

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bench/load/curves.h"
#include "bench/load/load_setup.h"

namespace furrow::bench {

// Returns a table with the cost of one performer at 60 Hz and the requirements of 10,000, computed
// from the curve of subjects. Processor time and memory are slopes between the points with the
// fewest and the most subjects without loss, so the base cost of a daemon does not count.
[[nodiscard]] std::string BudgetMarkdown(const Curve& subjects, const LoadSetup& setting);

}  // namespace furrow::bench

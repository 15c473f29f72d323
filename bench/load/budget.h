// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bench/load/curves.h"
#include "bench/load/setting.h"

namespace furrow::bench {

// What a performer at 60 Hz costs and what 10,000 of them ask for, from the curve of subjects: a
// table. Processor time and memory are slopes between the points with the fewest and the most
// subjects that lost nothing, so that what a daemon costs by itself does not count.
[[nodiscard]] std::string BudgetMarkdown(const Curve& subjects, const Setting& setting);

}  // namespace furrow::bench

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bench/report/micro_results.h"

namespace furrow::bench {

// Markdown tables of what bench_wrinkle and bench_codec measured. What was left out there ends the
// program.
[[nodiscard]] std::string SolverTables(const MicroResults& results);
[[nodiscard]] std::string CodecTables(const MicroResults& results);

}  // namespace furrow::bench

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bench/report/micro_results.h"

namespace furrow::bench {

// Return Markdown tables of the results of bench_wrinkle and bench_codec. A missing measurement
// exits the program.
[[nodiscard]] std::string SolverTables(const MicroResults& results);
[[nodiscard]] std::string CodecTables(const MicroResults& results);

}  // namespace furrow::bench

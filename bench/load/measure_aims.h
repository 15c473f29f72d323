// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bench/load/load_setup.h"
#include "bench/report/aims.h"

namespace furrow::bench {

// Compares the daemon with raw UDP echo servers on the same core, in alternating runs: latency at
// 10,000 poses per second, processor time at 50,000, the highest rate without loss, 1,000 subjects
// at 60 Hz, stalled subscribers, and memory at rest.
[[nodiscard]] std::vector<Aim> MeasureAims(const LoadSetup& setting);

}  // namespace furrow::bench

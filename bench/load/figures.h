// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bench/load/setting.h"
#include "bench/report/aims.h"

namespace furrow::bench {

// Latency at 10,000 poses a second, processor time at 50,000, the highest rate without loss, 1,000
// subjects at 60 Hz, stalled subscribers, and memory at rest: the daemon beside raw UDP echoes on
// the same core, runs in turn.
[[nodiscard]] std::vector<Aim> MeasureAims(const Setting& setting);

}  // namespace furrow::bench

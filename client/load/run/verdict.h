// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/load/run/run.h"

namespace furrow::load {

// True if the server sustained the rate of a run: every due pose was sent, no weights were lost,
// wrong or invented, the run completed, and the 99th percentile of the latency is below
// `p99_limit_us` microseconds.
[[nodiscard]] bool IsSustained(const RunResult& result, double p99_limit_us);

// True if a run has no defect, as --strict demands: every due pose was sent, no weights were lost,
// wrong, invented, late or malformed, all weights were checked, and the run completed.
[[nodiscard]] bool IsClean(const RunResult& result);

// True if the load generator was too slow: it did not send all due poses, lost datagrams in its own
// buffers, or has a p99 of the send delay above half of the limit. A faster generator might show
// that the server sustains the rate.
[[nodiscard]] bool GeneratorFellBehind(const RunResult& result, double p99_limit_us);

}  // namespace furrow::load

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/load/run.h"

namespace furrow::load {

// Whether a rate was held: every pose that was due left, nothing was lost, wrong or made up, the
// run came to its end, and p99 is below the limit. The one definition of it.
[[nodiscard]] bool Held(const RunResult& result, double p99_limit_us);

// Whether nothing at all can be said against a run: Held() but for the percentile, and nothing was
// late or undecodable, and every weight was checked. What --strict asks for.
[[nodiscard]] bool Clean(const RunResult& result);

// Whether the sending side was the one that fell behind: poses that did not leave, datagrams lost
// in its own buffers, or a p99 of its delay to send beyond half of the limit. What such a run did
// not hold, a faster generator might.
[[nodiscard]] bool GeneratorFellBehind(const RunResult& result, double p99_limit_us);

}  // namespace furrow::load

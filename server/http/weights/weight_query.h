// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <vector>

#include "base/status.h"
#include "protocol/messages/messages.h"
#include "server/http/request/url.h"

namespace furrow::server {

// What a client of /weights asks for.
struct WeightQuery {
  std::vector<protocol::SubscribeWeights> requests;  // one per subject
  std::chrono::milliseconds alive{10'000};           // longest time without a line
};

// Reads the query of /weights (default: all weights of the oldest subject). Keys: `subject`
// (repeatable), `pattern`, `rate` (frames per second in [0, 1000]; 0: every pose), `every` (true or
// false; see protocol::SubscribeWeights), `alive` (seconds in [0.1, 60]). Errors: kInvalidArgument,
// with the key as `where`.
[[nodiscard]] Result<WeightQuery> WeightsOf(const Url& url);

}  // namespace furrow::server

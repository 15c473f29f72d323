// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <new>

#include "server/core/metrics.h"

namespace furrow::server {

// Runs an event loop of Asio, or of Boost.Asio, until it is stopped or has nothing to wait for. A
// handler that lacks memory ends alone: strangers can cause that. Other exceptions propagate, among
// them those of what the daemon cannot work without (StartCriticalTask()).
template <class Loop>
void RunLoop(Loop& loop, Metrics* metrics) {
  while (true) {
    try {
      loop.run();
      return;
    } catch (const std::bad_alloc&) {
      metrics->Add(Counter::kAllocationsFailed);
    }
  }
}

}  // namespace furrow::server

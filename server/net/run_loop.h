// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/core/within_memory.h"

namespace furrow::server {

// Runs an event loop of Asio, or of Boost.Asio, until it is stopped or has nothing to wait for. A
// handler that lacks memory ends alone: strangers can cause that. Other exceptions propagate, among
// them those of what the daemon cannot work without (StartCriticalTask()).
template <class Loop>
void RunLoop(Loop& loop, Metrics* metrics) {
  while (!WithinMemory(metrics, [&loop] { loop.run(); })) {
  }
}

}  // namespace furrow::server

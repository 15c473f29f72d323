// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <new>

#include "server/core/metrics.h"

namespace furrow::server {

// Runs a part of the daemon's work. Lack of memory costs this part, not the daemon, and is counted.
// Returns false if it did. Other exceptions propagate.
template <class Work>
bool WithinMemory(Metrics* metrics, const Work& work) {
  try {
    work();
    return true;
  } catch (const std::bad_alloc&) {
    metrics->Add(Counter::kAllocationsFailed);
    return false;
  }
}

}  // namespace furrow::server

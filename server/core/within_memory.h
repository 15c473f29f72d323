// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <new>

#include "base/status.h"
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

// Runs `work`, which returns a Status or a Result. Lack of memory becomes its error.
template <class Work>
auto OrOutOfMemory(Metrics* metrics, const char* where, const Work& work) -> decltype(work()) {
  try {
    return work();
  } catch (const std::bad_alloc&) {
    metrics->Add(Counter::kAllocationsFailed);
    return Status(StatusCode::kInternal, "out of memory", where);
  }
}

}  // namespace furrow::server

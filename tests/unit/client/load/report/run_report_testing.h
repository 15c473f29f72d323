// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/load/run/run.h"

namespace furrow::load {

// A run without defects: 100 poses with a latency of 1 ms, in the first 10 of 50 windows.
inline RunResult GoodRun() {
  RunResult result;
  result.tally = {.offered = 100, .sent = 100, .expected = 100, .received = 100, .checked = 100};
  for (int i = 0; i < 100; ++i) {
    result.latency_ns.Record(1'000'000);
    result.send_delay_ns.Record(1'000);
  }
  result.windows.resize(50);
  for (int i = 0; i < 10; ++i) result.windows[static_cast<std::size_t>(i)].Record(1'000'000 + i);
  result.seconds = 10.0;
  result.planned_seconds = 10.0;
  result.checked_names = true;
  return result;
}

}  // namespace furrow::load

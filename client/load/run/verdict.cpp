// SPDX-License-Identifier: Apache-2.0
#include "client/load/run/verdict.h"

namespace furrow::load {
namespace {

// True if all due poses were sent and all weights came back correct.
bool Whole(const RunResult& result) {
  const Tally& tally = result.tally;
  return tally.sent == tally.offered && tally.lost() == 0 && tally.wrong == 0 &&
         tally.never_sent == 0 && !result.ended_early && !result.interrupted;
}

}  // namespace

bool IsSustained(const RunResult& result, double p99_limit_us) {
  return Whole(result) && result.p(99.0) < p99_limit_us;
}

bool IsClean(const RunResult& result) {
  const Tally& tally = result.tally;
  return Whole(result) && tally.late == 0 && tally.unchecked == 0 && result.malformed == 0 &&
         result.checked_names;
}

bool GeneratorFellBehind(const RunResult& result, double p99_limit_us) {
  const double delay_us = static_cast<double>(result.send_delay_ns.Percentile(99.0)) * 1e-3;
  return result.tally.sent < result.tally.offered || result.overrun > 0 ||
         delay_us > 0.5 * p99_limit_us;
}

}  // namespace furrow::load

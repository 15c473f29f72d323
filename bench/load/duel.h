// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/load/setting.h"
#include "client/load/compare/comparison.h"
#include "client/load/schedule/workload.h"

namespace furrow::bench {

// Three servers on one core, runs in turn: the one that is judged, what it is held against, and
// the latter once more, which says what a ratio of 1 looks like. 256 subjects of the setting's
// recording, packed.
class Duel {
 public:
  // The servers stay the caller's. `searches`: of each for its highest rate, but no more than
  // rounds.
  Duel(const Setting& setting, const load::ComparisonTargets& contestants, int searches);

  // The setting's rounds at so many poses a second.
  [[nodiscard]] load::Comparison At(double rate);
  // The highest rate without loss.
  [[nodiscard]] load::Comparison Highest();

 private:
  [[nodiscard]] load::Comparison Run(const load::ComparisonOptions& options);

  load::ComparisonTargets contestants_;
  load::ComparisonOptions options_;
  load::Workload performance_;
};

// Of one of its figures: a median ratio, and between what the middle half lies.
[[nodiscard]] std::string Between(const load::Quartiles& ratio);

}  // namespace furrow::bench

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "client/load/measure/expected.h"
#include "client/load/measure/histogram.h"
#include "client/load/schedule/plan.h"

namespace furrow::load {

// What came back of what was sent, as far as it was told when it came.
struct Tally {
  std::uint64_t offered = 0;     // poses that were due
  std::uint64_t sent = 0;        // of them, those that left
  std::uint64_t expected = 0;    // weights: one a pose sent and watcher of its subject
  std::uint64_t received = 0;    // of them, each once
  std::uint64_t late = 0;        // of the received, those beyond the limit
  std::uint64_t early = 0;       // of the received, those before their pose was due: see below
  std::uint64_t duplicates = 0;  // came again
  std::uint64_t reordered = 0;   // came after a newer one of their subject
  std::uint64_t never_sent = 0;  // of poses that were not sent: a wrong sequence
  std::uint64_t checked = 0;     // weights compared with the solver's
  std::uint64_t unchecked = 0;   // received, but the solver cannot know (a long gap, another rig)
  std::uint64_t unfollowed = 0;  // of the unchecked: differed, but were too many to be replayed
  // Of the checked, those beyond the tolerance. Of them, those equal to another pose's or
  // subject's, and those beyond the first 10,000, which are not looked for; the rest equals none.
  std::uint64_t wrong = 0;
  std::uint64_t swapped = 0;
  std::uint64_t unclassified = 0;
  float largest_difference = 0.0f;  // of the checked that are not wrong

  [[nodiscard]] std::uint64_t lost() const { return expected - received; }
  [[nodiscard]] std::uint64_t falsified() const { return wrong - swapped - unclassified; }
};

struct CheckOptions {
  int watchers = 1;          // each watches every subject
  float tolerance = 1e-4f;   // of a weight
  std::int64_t late_us = 0;  // beyond it a weight is late
  double seconds = 10.0;     // of the run, for the windows of time
};

// Judges each weight as it comes; what differs from the table is kept for Settle(), since a server
// that lost a pose on the way in rightly sends other weights for a while.
//
// Latency counts from when a pose was due, not from when it left. No pose leaves before it is due,
// so weights that come `early` say that clocks disagree: the latency counts as 0.
class Checker {
 public:
  static constexpr std::size_t kWindows = 50;

  // `expected` null: values are not looked at. All outlive the checker.
  Checker(const Plan& plan, const Expected* expected, const CheckOptions& options);

  // A pose was due; `left`: and went out.
  void OnSent(std::uint32_t subject, std::uint32_t pose, bool left);
  // `now_us` since the start of the run. `readable`: the names are those of the solver.
  void OnWeights(int watcher, std::uint32_t subject, std::uint32_t sequence,
                 std::span<const float> values, bool readable, std::int64_t now_us);

  // Replays the solver for what differed. Call it once, in the end. `performance` is that of the
  // expected table. `progress` is told the share done, several times a second, and ends the work by
  // false: what is left is unchecked then, and false is returned.
  [[nodiscard]] bool Settle(const Performance& performance,
                            const std::function<bool(double share)>& progress);

  [[nodiscard]] const Tally& tally() const { return tally_; }
  [[nodiscard]] const Histogram& latency_ns() const { return latency_; }
  // By when the pose was due: equal parts of the run.
  [[nodiscard]] std::span<const Histogram> windows() const { return windows_; }
  [[nodiscard]] bool complete() const { return tally_.received == tally_.expected; }

 private:
  struct Dispute {
    std::uint32_t pose = 0;
    std::size_t row = 0;  // in dispute_values_
  };
  // One subject as one watcher sees it.
  struct Track {
    std::uint32_t subject = 0;
    std::vector<bool> seen;
    std::int64_t newest = -1;
    std::vector<Dispute> disputes;
    std::vector<std::uint32_t> unfollowed;  // poses that differed
  };
  class Settlement;  // of one track

  void Compare(Track& track, std::uint32_t subject, std::uint32_t pose,
               std::span<const float> values);
  void Judge(std::span<const float> values, float difference);

  const Plan& plan_;
  const Expected* expected_;
  CheckOptions options_;
  Tally tally_;
  Histogram latency_;
  std::vector<Histogram> windows_;
  std::vector<std::vector<bool>> sent_;  // of each subject
  std::vector<Track> tracks_;            // watcher-major
  std::vector<float> dispute_values_;
};

}  // namespace furrow::load

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "client/load/measure/expected_weights.h"
#include "client/load/measure/histogram.h"
#include "client/load/schedule/plan.h"

namespace furrow::load {

// Counts of poses and weights.
struct Tally {
  std::uint64_t offered = 0;     // poses that were due
  std::uint64_t sent = 0;        // offered poses that were sent
  std::uint64_t expected = 0;    // weights messages: one per sent pose and watcher
  std::uint64_t received = 0;    // expected messages that arrived, each counted once
  std::uint64_t late = 0;        // received messages beyond the latency limit
  std::uint64_t early = 0;       // received messages that arrived before their pose was due
  std::uint64_t duplicates = 0;  // repeated messages
  std::uint64_t reordered = 0;   // messages that arrived after a newer one of their subject
  std::uint64_t never_sent = 0;  // messages with a sequence number that was not sent
  std::uint64_t checked = 0;     // messages compared with the solver's weights
  std::uint64_t unchecked = 0;   // received, but not predictable: after a long gap, or another rig
  std::uint64_t unfollowed = 0;  // unchecked because too many messages differed
  std::uint64_t aged = 0;        // messages without a new pose: the server held or decayed weights
  std::uint64_t wrong = 0;       // checked messages beyond the tolerance
  std::uint64_t swapped = 0;     // wrong messages that equal those of another pose or subject
  std::uint64_t unclassified =
      0;  // wrong messages after the first 10,000, not searched for a match
  float largest_difference = 0.0f;  // of the checked messages that are not wrong

  [[nodiscard]] std::uint64_t lost() const { return expected - received; }
  [[nodiscard]] std::uint64_t falsified() const { return wrong - swapped - unclassified; }
};

// The options of a check.
struct CheckOptions {
  int watchers = 1;          // each receives every subject
  float tolerance = 1e-4f;   // largest accepted difference of a weight
  std::int64_t late_us = 0;  // latency limit, microseconds
  double seconds = 10.0;     // length of the run, for the time windows
};

// Checks each weights message as it arrives against a precomputed table. Messages that differ from
// the table are kept for ResolveMismatches(): a server that lost a pose on the way in correctly
// sends other weights for a while, because its filter saw another time step.
//
// Latency counts from the due time of a pose, not from its send time. No pose is sent before it is
// due, so an `early` message means that clocks disagree; its latency counts as 0.
class Checker {
 public:
  // Number of windows(): enough for a curve over time.
  static constexpr std::size_t kWindows = 50;

  // `expected`: null to not check values. `plan` and `expected` must outlive the checker.
  Checker(const Plan& plan, const ExpectedWeights* expected, const CheckOptions& options);

  // Records that a pose was due. `sent`: it was sent successfully.
  void OnDue(std::uint32_t subject, std::uint32_t pose, bool sent);
  // Records weights that arrived `now_us` microseconds after the start of the run. `watcher`: in
  // [0, CheckOptions::watchers). `readable`: the names of the weights equal the solver's.
  void OnWeights(int watcher, std::uint32_t subject, std::uint32_t sequence,
                 std::span<const float> values, bool readable, std::int64_t now_us);
  // Records weights with an age, which belong to no new pose: the server has received none after
  // `sequence` for so long that it holds and decays the weights by its own clock. Weights of the
  // next kForgottenUs depend on that decay, so mismatches among them are unchecked.
  void OnAged(int watcher, std::uint32_t subject, std::uint32_t sequence, std::int64_t now_us);

  // Decides which mismatches are wrong, by replaying the solver. Call it once, at the end, with the
  // workload of the expected table. `progress` receives the completed share in [0, 1] several times
  // per second. If it returns false, the remaining mismatches count as unchecked and the function
  // returns false.
  [[nodiscard]] bool ResolveMismatches(const Workload& workload,
                                       const std::function<bool(double share)>& progress);

  [[nodiscard]] const Tally& tally() const { return tally_; }
  // Latency of all received messages, nanoseconds.
  [[nodiscard]] const Histogram& latency_ns() const { return latency_; }
  // Latency in kWindows equal parts of the run, by due time, nanoseconds.
  [[nodiscard]] std::span<const Histogram> windows() const { return windows_; }
  // True if all expected messages have arrived.
  [[nodiscard]] bool complete() const { return tally_.received == tally_.expected; }

 private:
  struct Mismatch {
    std::uint32_t pose = 0;
    std::size_t row = 0;  // index in mismatch_values_
  };
  // What one watcher received of one subject.
  struct Track {
    std::uint32_t subject = 0;
    std::vector<bool> seen;
    std::int64_t newest = -1;
    std::vector<Mismatch> mismatches;
    std::vector<std::uint32_t> unfollowed;  // poses whose mismatch was not kept
    std::vector<std::uint32_t> decayed;     // poses after which the server decayed the weights
  };
  class MismatchResolver;  // works on one track

  void Compare(Track& track, std::uint32_t subject, std::uint32_t pose,
               std::span<const float> values);
  void Classify(std::span<const float> values, float difference);

  const Plan& plan_;
  const ExpectedWeights* expected_;
  CheckOptions options_;
  Tally tally_;
  Histogram latency_;
  std::vector<Histogram> windows_;
  std::vector<std::vector<bool>> sent_;  // per subject
  std::vector<Track> tracks_;            // watcher-major
  std::vector<float> mismatch_values_;
};

}  // namespace furrow::load

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "client/load/measure/expected.h"
#include "client/load/schedule/performance.h"
#include "client/load/schedule/plan.h"
#include "wrinkle/solver/solver.h"

namespace furrow::load {

// What a server could rightly have sent for one subject, where some weights are missing: whether a
// pose was lost on the way in (then the filter never saw it) or its weights on the way out (then it
// did) cannot be told, so both are followed up, and what comes next tells which were possible.
//
// Poses are given in order, each once, by one of three calls.
class Replay {
 public:
  // `first`: the pose it begins with, as if the filter had known none before.
  Replay(const Performance& performance, const Plan& plan, std::uint32_t subject,
         const Expected& expected, float tolerance, std::uint32_t first = 0);

  // No weights came of this pose.
  void Missing(std::uint32_t pose);
  // They came and were those of the expected table: how far that is from the nearest possible.
  float Agreed(std::uint32_t pose);
  // They came and were others: how far they are from the nearest that is possible. Nothing where
  // that cannot be said: after a gap in which the server held and decayed by its own clock, or one
  // with more possibilities than were followed up, none of which fits.
  [[nodiscard]] std::optional<float> Disputed(std::uint32_t pose, std::span<const float> values);

 private:
  struct Branch {
    wrinkle::SubjectSolver solver;
    std::int64_t last_us = -1;  // capture time of the last pose used; -1: none
  };

  void Use(Branch& branch, std::uint32_t pose);
  // Solves this pose in all branches and keeps those that say `values`; all if none does.
  float Observe(std::uint32_t pose, std::span<const float> values);
  void Prune();

  const Performance& performance_;
  const Plan& plan_;
  const Expected& expected_;
  int phase_;
  float tolerance_;
  std::vector<Branch> branches_;
  std::int64_t last_seen_us_ = 0;
  std::int64_t unsettled_until_us_ = -1;
  bool overflowed_ = false;  // not all possibilities are in `branches_`
  wrinkle::LocalPose pose_;
};

}  // namespace furrow::load

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "client/load/measure/expected_weights.h"
#include "client/load/schedule/plan.h"
#include "client/load/schedule/workload.h"
#include "wrinkle/solver/solver.h"

namespace furrow::load {

// The weights that a correct server may send for one subject when some weights are missing.
//
// A missing message has two possible causes. If the pose was lost on the way in, the filter of the
// server never saw it. If the weights were lost on the way out, the filter did. The replay follows
// both possibilities as branches; later messages rule branches out.
//
// Report the poses in order, each once, by one of the three functions.
class Replay {
 public:
  // `first`: the pose to start with, before which the filter is in its initial state. `tolerance`:
  // largest accepted difference of a weight. `workload`, `plan` and `expected` must outlive the
  // replay.
  Replay(const Workload& workload, const Plan& plan, std::uint32_t subject,
         const ExpectedWeights& expected, float tolerance, std::uint32_t first = 0);

  // No weights arrived for this pose.
  void Missing(std::uint32_t pose);
  // Weights equal to the expected table arrived. Returns their distance from the nearest branch.
  float Agreed(std::uint32_t pose);
  // Other weights arrived. Returns their distance from the nearest branch, or nothing if no branch
  // fits and that proves nothing: after a gap in which the server may have held and decayed the
  // weights by its own clock, or after a gap with more possibilities than branches.
  [[nodiscard]] std::optional<float> Mismatched(std::uint32_t pose, std::span<const float> values);

 private:
  struct Branch {
    wrinkle::SubjectSolver solver;
    std::optional<std::int64_t> last_us = {};  // capture time of the last solved pose
  };

  void Use(Branch& branch, std::uint32_t pose);
  // Solves this pose in all branches and keeps the branches that give `values`, or all if none
  // does.
  float Observe(std::uint32_t pose, std::span<const float> values);
  void Prune();

  const Workload& workload_;
  const Plan& plan_;
  const ExpectedWeights& expected_;
  std::uint32_t subject_;
  int phase_;
  float tolerance_;
  std::vector<Branch> branches_;
  std::int64_t last_seen_us_ = 0;
  std::int64_t unsettled_until_us_ = -1;
  bool overflowed_ = false;  // `branches_` does not hold all possibilities
  wrinkle::LocalPose pose_;
};

}  // namespace furrow::load

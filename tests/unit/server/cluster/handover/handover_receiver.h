// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "handover_simulation.h"

namespace furrow::server::testing {

// The receiver of the weights of a simulated subject, and the rules that it checks: no two nodes
// serve one epoch, and a pose never goes back. All times are those of the simulation, ms.
class HandoverReceiver {
 public:
  // A node in another life is another node.
  using Owner = std::pair<int, std::uint64_t>;

  // `begin`: from then on, gaps count.
  explicit HandoverReceiver(std::int64_t begin) : begin_(begin), last_fault_(begin) {}

  // The first frame may come from now on.
  void Start(std::int64_t now) { last_used_ = now; }
  // A fault lasts until `end`. Gaps after the last one are counted apart, too.
  void NoteFault(std::int64_t end) { last_fault_ = std::max(last_fault_, end); }
  [[nodiscard]] std::int64_t last_fault() const { return last_fault_; }

  // The first broken rule is kept.
  void Fail(std::string fault, std::int64_t now);
  void NoteServing(const Owner& owner, std::uint64_t epoch, std::int64_t now);
  // The receiver keeps to epochs. `warm`: of an epoch that went on with a state, in which numbers
  // grow, too.
  void OnFrame(std::uint64_t epoch, bool warm, std::uint32_t sequence, std::int64_t now);
  // Measures the time since the last frame.
  void NoteGap(std::int64_t now);
  // Served without a break since the last fault.
  [[nodiscard]] bool HasSettled(std::int64_t now) const;

  [[nodiscard]] HandoverOutcome& outcome() { return outcome_; }
  [[nodiscard]] const HandoverOutcome& outcome() const { return outcome_; }

 private:
  std::int64_t begin_;
  std::int64_t last_fault_;
  std::map<std::uint64_t, Owner> owners_;  // by epoch
  std::pair<std::uint64_t, std::uint32_t> newest_{0, 0};
  std::int64_t last_used_ = 0;
  std::int64_t calm_since_ = 0;
  HandoverOutcome outcome_;
};

}  // namespace furrow::server::testing

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace furrow::server::testing {

// What happened in one schedule, or in many.
struct LeaseOutcome {
  std::string fault;            // the first rule that was broken; empty: none
  std::int64_t longest_ms = 0;  // longest time without a frame that the receiver could use
  std::int64_t settled_ms = 0;  // the same, counted from the end of the last fault
  std::uint64_t frames = 0;     // that the receiver used
  std::uint64_t fenced = 0;     // that the receiver dropped, because they were of a lower epoch
  std::uint64_t epochs = 0;     // that were served
  std::uint64_t overlaps = 0;   // moments at which two nodes served the subject
};

// The kinds of faults of a schedule; a sum.
enum LeaseFault : unsigned {
  kCrash = 1,   // a node loses its memory and comes back later, or never
  kFreeze = 2,  // a node does not run for a while, and then handles everything at once
  kCut = 4,     // a node and the store do not hear each other
  kStoreDown = 8,
  kStoreEmptied = 16,
  kClockStep = 32,  // of a system's clock: by hours, or by a second where the store is emptied
  kPublisherCut = 64,
  kAllFaults = 127,
};

// Runs three nodes, a store, a publisher and a receiver through faults that follow from the seed,
// over a network that delays and reorders. No clock, no thread. `most_faults`: in one schedule.
[[nodiscard]] LeaseOutcome SimulateLeases(std::uint64_t seed, bool strict,
                                          unsigned faults = kAllFaults, int most_faults = 5);

}  // namespace furrow::server::testing

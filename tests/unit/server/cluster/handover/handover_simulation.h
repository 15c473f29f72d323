// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace furrow::server::testing {

inline constexpr std::size_t kHandoverFaultKinds = 10;

// What happened in one schedule, or in many.
struct HandoverOutcome {
  std::string fault;              // the first rule that was broken; empty: none
  std::int64_t gap_ms = 0;        // longest time between two frames that the receiver could use
  std::int64_t settled_ms = 0;    // the same, counted from the end of the last fault
  std::uint64_t handovers = 0;    // leases that went to an heir
  std::uint64_t warm = 0;         // heirs that went on with the state
  std::uint64_t cold = 0;         // nodes that began without one
  std::uint64_t passed_over = 0;  // nodes that were asked and did not take the subject
  std::uint64_t frames = 0;       // that the receiver used
  std::uint64_t fenced = 0;       // that the receiver dropped, because they were of a lower epoch
  std::uint64_t overlaps = 0;     // moments at which two nodes served the subject
  // By HandoverFault, from the lowest bit: faults that met a node or a hand-over.
  std::array<std::uint64_t, kHandoverFaultKinds> faults{};

  HandoverOutcome& operator+=(const HandoverOutcome& other);
};

// The kinds of faults of a schedule; a sum.
enum HandoverFault : unsigned {
  kNodeCrash = 1,        // loses its memory and comes back later
  kNodeFreeze = 2,       // does not run for a while, and then handles everything at once
  kStoreCut = 4,         // a node and the store do not hear each other
  kStoreEnd = 8,         // nobody hears the store
  kLinkCut = 16,         // two nodes do not hear each other, or only one does
  kLinkLoss = 32,        // many datagrams between nodes are lost, come twice or late
  kNodeFull = 64,        // a node takes nothing for a while
  kPublisherAway = 128,  // the publisher and a node do not hear each other
  kSecondDrain = 256,    // another node is drained, too, which may be the heir
  kShortTime = 512,      // a node ends by SIGTERM, whether or not its subject has moved
  kAllHandoverFaults = (1u << kHandoverFaultKinds) - 1,
};

// Three nodes, a store, a publisher and a receiver; the node that serves the subject is drained,
// ends, and comes back. Faults follow from the seed; most of them begin during the hand-over, and
// half of them hit one of the two nodes that take part. LeaseKeeper, Handovers, Arrivals and the
// wire's fragments are the real ones; the rules of hub and coordinator are copies. No clock, no
// thread. `most_faults`: in one schedule.
[[nodiscard]] HandoverOutcome SimulateHandovers(std::uint64_t seed, bool strict,
                                                unsigned faults = kAllHandoverFaults,
                                                int most_faults = 4);

}  // namespace furrow::server::testing

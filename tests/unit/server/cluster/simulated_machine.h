// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <utility>

#include "server/cluster/lease/lease_keeper.h"
#include "server/core/time.h"
#include "tests/unit/server/cluster/event_queue.h"

namespace furrow::server::testing {

// The computer of one node in a simulation: its clocks, its freezes, and what it knows of the
// store. Times are in ms of the simulation, unless they are a Time, which the node's clock shows.
struct SimulatedMachine {
  using Ms = std::int64_t;
  static constexpr Ms kListMs = 1000;    // between listings
  static constexpr Ms kNoticeMs = 1500;  // until an adapter notices that the store is gone

  std::uint64_t life = 0;
  Ms frozen_until = 0;
  Ms cut_until = 0;  // from the store
  Ms wall_offset = 0;
  bool told = false;  // what the keeper believes of the store

  // Begins a life in which the clock began at `origin_at` and gains `drift_now` parts in a
  // thousand.
  void Start(Ms now, Ms origin_at, Ms drift_now) {
    ++life;
    origin = origin_at;
    drift = drift_now;
    ran = Clock(now);
    told = false;
    unheard_since = -1;
    listed_at = -kListMs;
  }
  [[nodiscard]] Time Clock(Ms now) const {
    const Ms elapsed = now - origin;
    return std::chrono::milliseconds(100'000 + elapsed + elapsed * drift / 1000);
  }
  // What the adapter tells the keeper each time the node runs. `hears`: the store, at this moment.
  void Notice(bool hears, Ms now, LeaseKeeper* keeper) {
    const Time clock = Clock(now);
    const Time pause = clock - std::exchange(ran, clock);
    keeper->OnPause(pause, clock);
    // A listing that was requested before a freeze says nothing.
    if (pause > kLeaseFreeze) list_used = list_number + 1;
    if (hears) {
      unheard_since = -1;
    } else if (unheard_since < 0) {
      unheard_since = now;
    }
    const bool reachable = hears || (told && now - unheard_since < kNoticeMs);
    if (reachable == told) return;
    told = reachable;
    keeper->OnReachable(reachable, clock);
  }
  // True if the adapter asks for a listing now. `tick`: between looks at the keeper's wish.
  [[nodiscard]] bool AsksForListing(const LeaseKeeper& keeper, Ms now, Ms tick) const {
    const Ms passed = now - listed_at;
    return told && (passed >= kListMs || (keeper.needs_listing() && passed >= 2 * tick));
  }
  // The number of a new request.
  [[nodiscard]] std::uint64_t AskForListing(Ms now) {
    listed_at = now;
    return ++list_number;
  }
  // False: a later request has been answered before.
  [[nodiscard]] bool TakeListing(std::uint64_t number) {
    if (number < list_used) return false;
    list_used = number;
    return true;
  }

 private:
  Ms origin = 0;  // of the monotonic clock
  Ms drift = 0;   // parts in a thousand
  Time ran{0};    // when it ran last
  Ms unheard_since = -1;
  Ms listed_at = -kListMs;
  std::uint64_t list_number = 0;
  std::uint64_t list_used = 0;
};

// Calls action(*node) at `time` on a node: a SimulatedMachine with runs(). Not in a later life, and
// not while it is frozen. `thaw`: returns by how many ms later it runs after a freeze.
template <class Node, class Thaw, class Action>
void RunOnNode(EventQueue* events, Node* node, std::int64_t time, Thaw thaw, Action action) {
  events->At(time, [events, node, thaw, life = node->life, action = std::move(action)]() mutable {
    if (node->life != life || !node->runs()) return;
    if (node->frozen_until > events->now()) {
      return RunOnNode(events, node, node->frozen_until + thaw(), thaw, std::move(action));
    }
    action(*node);
  });
}

}  // namespace furrow::server::testing

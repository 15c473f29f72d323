// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"
#include "server/cluster/place.h"
#include "server/core/time.h"

namespace furrow::server {

// What a node knows of the cluster, for people and supervisors.
struct ClusterState {
  struct Node {
    NodeAddress address;
    int subjects = 0;
    int capacity = 0;
    bool draining = false;
    bool self = false;
  };
  struct Subject {
    std::string name;
    std::string node;
    std::uint64_t epoch = 0;
  };
  std::string fault;  // why nothing new is placed; empty: nothing is wrong
  std::vector<Node> nodes;
  std::vector<Subject> subjects;  // of all nodes
};

// Decides which node of a cluster serves which subject. A daemon without a cluster has none.
//
// All functions return at once: what takes time happens on a thread of the coordinator. The hub
// calls them under its exclusive lock; State() and Find() may be called from any thread.
class Coordinator {
 public:
  virtual ~Coordinator() = default;

  // Begins, once clients reach this node at the address. Errors: those of the options.
  [[nodiscard]] virtual Status Start(const NodeAddress& self) = 0;
  // A stream offers the subject here, or is still there. Takes the subject if it is free. The node
  // keeps it until Release().
  [[nodiscard]] virtual Place Ask(std::string_view subject, Time now) = 0;
  // Where the subject is served.
  [[nodiscard]] virtual Place Find(std::string_view subject, Time now) const = 0;
  // The other node that serves the subject; kNowhere if there is none.
  [[nodiscard]] virtual Place Elsewhere(std::string_view subject) const = 0;
  // Where a new subject should be offered: kHere or kElsewhere, or kNowhere.
  [[nodiscard]] virtual Place Propose(std::string_view subject, Time now) const = 0;
  // The other node that should take the subject from this one, but none of `without`; kNowhere,
  // with the reason, if there is none.
  [[nodiscard]] virtual Place Successor(std::string_view subject,
                                        const std::set<std::string>& without) const = 0;
  // Why subjects never move from this node to another one; empty: they do.
  [[nodiscard]] virtual std::string WhyNothingMoves() const { return {}; }
  // The other nodes that are there, those that are not draining first.
  [[nodiscard]] virtual std::vector<NodeAddress> Others() const = 0;
  // Another node is about to hand the subject over to this one, within kExpected. Until then, this
  // node sends nobody elsewhere for it. kPending, or kNowhere: this node does not take it.
  [[nodiscard]] virtual Place Expect(std::string_view subject, Time now) = 0;
  static constexpr Time kExpected = std::chrono::seconds(3);
  // This node serves the subject no longer, and the node `heir` goes on with it.
  virtual void HandOver(std::string_view subject, const NodeAddress& heir) = 0;
  // This node serves the subject no longer.
  virtual void Release(std::string_view subject) = 0;
  // Refuses new subjects from now on.
  virtual void SetDraining() = 0;
  [[nodiscard]] virtual ClusterState State(Time now) const = 0;
  // Why nothing new is placed, as ClusterState::fault.
  [[nodiscard]] virtual std::string Fault(Time now) const = 0;
};

}  // namespace furrow::server

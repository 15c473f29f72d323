// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/cluster/coordinator.h"

namespace furrow::server {

// A cluster without a store: a fixed list of nodes, and every subject belongs to the one that its
// name selects (rendezvous hashing, Thaler and Ravishankar 1998: a node that is added or removed
// moves only its own share). Nobody takes over from a node that is gone.
class StaticList : public Coordinator {
 public:
  // `nodes` includes one named `self`, which Start() replaces. The others speak HTTPS if this one
  // has TLS.
  StaticList(std::string self, std::vector<NodeAddress> nodes)
      : self_(std::move(self)), nodes_(std::move(nodes)) {}

  [[nodiscard]] Status Start(const NodeAddress& self) override;
  [[nodiscard]] Place Ask(std::string_view subject, Time now) override;
  [[nodiscard]] Place Find(std::string_view subject, Time now) const override;
  [[nodiscard]] Place Elsewhere(std::string_view subject) const override;
  [[nodiscard]] Place Propose(std::string_view subject, Time now) const override;
  [[nodiscard]] Place Successor(std::string_view subject,
                                const std::set<std::string>& without) const override;
  [[nodiscard]] std::string WhyNothingMoves() const override;
  [[nodiscard]] std::vector<NodeAddress> Others() const override;
  [[nodiscard]] Place Expect(std::string_view subject, Time now) override;
  void HandOver(std::string_view /*subject*/, const NodeAddress& /*heir*/) override {}
  void Release(std::string_view /*subject*/) override {}
  void SetDraining() override { draining_ = true; }
  [[nodiscard]] ClusterState State(Time now) const override;
  [[nodiscard]] std::string Fault(Time /*now*/) const override { return {}; }

 private:
  const std::string self_;
  std::vector<NodeAddress> nodes_;
  bool draining_ = false;
};

}  // namespace furrow::server

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "server/cluster/coordinator.h"

namespace furrow::server {

// Places that the test decides.
class FakeCluster : public Coordinator {
 public:
  Status Start(const NodeAddress& /*self*/) override { return {}; }
  Place Ask(std::string_view subject, Time now) override {
    asked.emplace_back(subject);
    return Find(subject, now);
  }
  Place Find(std::string_view subject, Time /*now*/) const override {
    const auto found = places.find(std::string(subject));
    return found == places.end() ? Place() : found->second;
  }
  Place Elsewhere(std::string_view subject) const override {
    const Place place = Find(subject, Time{0});
    if (only_proposed) return {};
    return place.kind == Place::Kind::kElsewhere ? place : Place();
  }
  Place Propose(std::string_view subject, Time now) const override { return Find(subject, now); }
  Place Successor(std::string_view /*subject*/,
                  const std::set<std::string>& without) const override {
    return without.contains(successor.node.name) ? Place() : successor;
  }
  std::string WhyNothingMoves() const override { return why_nothing_moves; }
  std::vector<NodeAddress> Others() const override { return {kOther}; }
  Place Expect(std::string_view subject, Time /*now*/) override {
    expected.emplace_back(subject);
    return expects;
  }
  void HandOver(std::string_view subject, const NodeAddress& heir) override {
    places[std::string(subject)] = At(heir);
  }
  void Release(std::string_view subject) override { released.emplace_back(subject); }
  void SetDraining() override { draining = true; }
  ClusterState State(Time /*now*/) const override { return {}; }
  std::string Fault(Time /*now*/) const override { return {}; }

  static Place Here(Time until, std::uint64_t epoch) {
    Place place;
    place.kind = Place::Kind::kHere;
    place.until = until;
    place.epoch = epoch;
    return place;
  }
  static Place At(const NodeAddress& node) {
    Place place;
    place.kind = Place::Kind::kElsewhere;
    place.node = node;
    return place;
  }
  inline static const NodeAddress kOther{"b", "host-b", 1, 2, 3};

  std::map<std::string, Place> places;
  Place successor;
  std::string why_nothing_moves;
  std::vector<std::string> asked;
  std::vector<std::string> released;
  std::vector<std::string> expected;
  Place expects;  // the result of Expect()
  bool draining = false;
  bool only_proposed = false;  // a node elsewhere has room, but does not serve the subject
};

}  // namespace furrow::server

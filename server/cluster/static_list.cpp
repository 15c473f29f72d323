// SPDX-License-Identifier: Apache-2.0
#include "server/cluster/static_list.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "protocol/messages/hash.h"

namespace furrow::server {
namespace {

constexpr char kListDecides[] = "a fixed list of nodes decides where subjects are served";

// The last mixing step is needed: without it, names that differ in their last letter alone would
// select nodes unevenly.
std::uint64_t Weight(std::string_view node, std::string_view subject) {
  protocol::Hasher hasher;
  hasher.String(node);
  hasher.String(subject);
  std::uint64_t hash = hasher.value();
  hash ^= hash >> 33;
  hash *= 0xff51afd7ed558ccd;
  return hash ^ (hash >> 33);
}

}  // namespace

Status StaticList::Start(const NodeAddress& self) {
  for (NodeAddress& node : nodes_) {
    node.https = self.https;
    if (node.name == self_) node = self;
  }
  return {};
}

Place StaticList::Find(std::string_view subject, Time /*now*/) const {
  const auto best =
      std::max_element(nodes_.begin(), nodes_.end(), [subject](const auto& a, const auto& b) {
        return Weight(a.name, subject) < Weight(b.name, subject);
      });
  Place place;
  place.kind = best->name == self_ ? Place::Kind::kHere : Place::Kind::kElsewhere;
  place.node = *best;
  place.until = kNoEnd;
  return place;
}

Place StaticList::Elsewhere(std::string_view subject) const {
  Place place = Find(subject, Time{0});
  return place.kind == Place::Kind::kElsewhere ? place : Place();
}

Place StaticList::Ask(std::string_view subject, Time now) {
  Place place = Find(subject, now);
  if (place.kind == Place::Kind::kHere && draining_) {
    place.kind = Place::Kind::kNowhere;
    place.why = "this node is draining";
  }
  return place;
}

Place StaticList::Propose(std::string_view subject, Time now) const { return Find(subject, now); }

Place StaticList::Expect(std::string_view /*subject*/, Time /*now*/) {
  Place place;
  place.why = kListDecides;
  return place;
}

std::string StaticList::WhyNothingMoves() const { return kListDecides; }

// The list alone decides, so nobody takes a subject of this node.
Place StaticList::Successor(std::string_view subject,
                            const std::set<std::string>& /*without*/) const {
  Place place = Elsewhere(subject);
  if (place.kind == Place::Kind::kNowhere) place.why = kListDecides;
  return place;
}

std::vector<NodeAddress> StaticList::Others() const {
  std::vector<NodeAddress> others = nodes_;
  std::erase_if(others, [this](const NodeAddress& node) { return node.name == self_; });
  return others;
}

ClusterState StaticList::State(Time /*now*/) const {
  ClusterState state;
  for (const NodeAddress& node : nodes_) {
    const bool is_self = node.name == self_;
    state.nodes.push_back({.address = node,
                           .subjects = 0,
                           .capacity = 0,
                           .draining = is_self && draining_,
                           .self = is_self});
  }
  return state;
}

}  // namespace furrow::server

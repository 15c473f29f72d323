// SPDX-License-Identifier: Apache-2.0
#include "server/session/departures.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <utility>

#include "server/cluster/lease/lease.h"
#include "server/session/subjects/subject_state.h"

namespace furrow::server {

// Empty: it may move.
std::string Departures::WhyItStays(const Subject& subject, Time now) {
  // The store has not confirmed the lease for longer than it takes. The other node would not get
  // the lease either.
  constexpr Time kLeast = kLeaseStop - kLeaseRenewal - std::chrono::milliseconds(500);
  if (subject.served_until - now < kLeast) return "the store of the cluster does not answer";
  const Peer* owner = OwnerOf(subject);
  if (owner == nullptr) return {};
  // Foreign wires, web pages, and a recording that this daemon plays itself.
  if (owner->transport == Transport::kMocap || owner->transport == Transport::kWeb) {
    return "its sender cannot be sent to another daemon";
  }
  // Its other subjects may go elsewhere, so such a client follows nobody.
  const auto is_of_owner = [owner](const std::unique_ptr<Subject>& other) {
    return other->owner.peer == owner->id && !other->ended;
  };
  const auto& all = parts_.subjects->all();
  return std::count_if(all.begin(), all.end(), is_of_owner) > 1
             ? "its sender has several subjects on one connection"
             : "";
}

Place Departures::SuccessorOf(std::string_view name, Time now,
                              const std::set<std::string>& without) {
  const Subject* subject = parts_.subjects->Find(name);
  Place place;
  if (subject == nullptr) {
    place.why = "it has left";
    return place;
  }
  place.why = WhyItStays(*subject, now);
  return place.why.empty() ? parts_.places->Successor(name, without) : place;
}

bool Departures::WriteState(std::string_view name, std::uint32_t number,
                            std::vector<std::uint8_t>& message) {
  const Subject* subject = parts_.subjects->Find(name);
  if (subject == nullptr) return false;
  parts_.messages->Encode(StateHeader(*subject, number), StateOf(*subject), message);
  return true;
}

Status Departures::HandOver(std::string_view name, const NodeAddress& node, std::uint32_t number,
                            std::vector<std::uint8_t>& message, Time now) {
  Subject* subject = parts_.subjects->Find(name);
  if (subject == nullptr) return {StatusCode::kNotFound, "it has left"};
  if (std::string why = WhyItStays(*subject, now); !why.empty()) {
    return {StatusCode::kUnavailable, std::move(why)};
  }
  // Poses that wait for their time are used now, because the publisher does not send them again.
  Shard& shard = parts_.shards->Of(subject->owner.peer);
  parts_.router->ReleaseStream(shard, subject->owner, now);
  parts_.messages->Encode(StateHeader(*subject, number), StateOf(*subject), message);
  parts_.publishers->SendAway(*subject, OwnerOf(*subject), node);
  parts_.places->HandOver(name, node);
  Move(*subject, node);
  parts_.subscribers->BindWaiting();
  return {};
}

// The publisher has been sent away already.
void Departures::Move(Subject& subject, const NodeAddress& node) {
  parts_.subscribers->OnSubjectMoved(subject, node);
  parts_.remove(subject);
}

void Departures::RenewPlaces(Time now) {
  std::vector<std::pair<Subject*, NodeAddress>> moved;
  for (const auto& subject : parts_.subjects->all()) {
    const std::uint64_t epoch = subject->epoch;
    const Place place = parts_.publishers->RenewPlace(*subject, OwnerOf(*subject), now);
    if (place.kind == Place::Kind::kElsewhere) moved.emplace_back(subject.get(), place.node);
    if (subject->epoch != epoch) parts_.subscribers->OnEpoch(*subject);
  }
  for (const auto& [subject, node] : moved) Move(*subject, node);
  if (!moved.empty()) parts_.subscribers->BindWaiting();
}

void Departures::SendAllAway(Time now) {
  parts_.places->Close();
  for (const auto& subject : parts_.subjects->all()) {
    const Place place = parts_.places->Successor(subject->name);
    if (place.kind != Place::Kind::kElsewhere) continue;
    parts_.publishers->SendAway(*subject, OwnerOf(*subject), place.node);
    parts_.subscribers->OnSubjectMoved(*subject, place.node);
  }
  for (const auto& subject : parts_.subjects->all()) {
    parts_.places->Release(subject->name);
    // Another node may serve it from now on. A right that never ends has no other node.
    if (subject->served_until != kNoEnd) subject->served_until = now;
  }
}

}  // namespace furrow::server

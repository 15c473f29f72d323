// SPDX-License-Identifier: Apache-2.0
#include "simulated_node.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "protocol/messages/cluster_messages.h"
#include "server/session/subjects/places.h"

namespace furrow::server::testing {
namespace {

// Those of Departures::WhyItStays() and Places.
constexpr Time kLeast = kLeaseStop - kLeaseRenewal - std::chrono::milliseconds(500);

Place At(int node) {
  Place place;
  place.kind = Place::Kind::kElsewhere;
  place.node.name = NameOf(node);
  return place;
}

Place Nowhere(std::string why) {
  Place place;
  place.why = std::move(why);
  return place;
}

}  // namespace

std::string NameOf(int node) { return std::string(1, static_cast<char>('a' + node)); }

int IndexOf(std::string_view name) { return name.empty() ? -1 : name[0] - 'a'; }

std::string TextOf(std::uint32_t newest) {
  return std::string(100 + newest * 1237 % 2200, static_cast<char>('a' + newest % 26));
}

SimulatedNode::SimulatedNode(int index, std::uint64_t run, bool strict, NodeSurroundings* others,
                             NodeLinks* links)
    : index_(index),
      run_(run),
      others_(others),
      keeper_(NameOf(index), run, strict),
      handovers_(this, links) {}

void SimulatedNode::TakeRequests() {
  if (const auto wanted = std::exchange(wanted_, std::nullopt)) {
    *wanted ? keeper_.Want(kSubject) : keeper_.Release(kSubject);
  }
  const int heir = std::exchange(next_heir_, -1);
  if (heir < 0) return;
  if (others_->IsThere(index_, heir)) {
    keeper_.HandOver(kSubject, NameOf(heir), others_->RunOf(heir));
  } else {
    keeper_.Release(kSubject);
  }
}

void SimulatedNode::Publish(Time now) {
  view_ = {.own = keeper_.ServingOf(kSubject, now),
           .holder = IndexOf(keeper_.HolderOf(kSubject, now)),
           .reachable = keeper_.reachable(),
           .may_take = keeper_.MayTake(now)};
}

int SimulatedNode::RoomElsewhere(const std::set<std::string>& without) const {
  if (!view_.reachable) return -1;
  for (int i = 1; i < kNodes; ++i) {
    const int node = (index_ + i) % kNodes;
    if (others_->IsThere(index_, node) && !others_->IsDraining(node) && others_->HasRoom(node) &&
        !without.contains(NameOf(node))) {
      return node;
    }
  }
  return -1;
}

Place SimulatedNode::Foreign(Time now) const {
  if (HasHeir(now)) return At(heir_);
  if (IsExpected(now)) return Nowhere("it is on its way");
  if (view_.holder < 0) return Nowhere("no node serves the subject");
  if (!others_->IsThere(index_, view_.holder)) return Nowhere("its node is not there");
  return others_->IsDraining(view_.holder) ? Nowhere("its node is draining") : At(view_.holder);
}

Place SimulatedNode::Find(Time now) const {
  if (!view_.own || now >= view_.own->until || HasHeir(now)) return Foreign(now);
  Place place;
  place.kind = Place::Kind::kHere;
  place.epoch = view_.own->epoch;
  place.until = view_.own->until;
  return place;
}

Place SimulatedNode::Propose(Time now) const {
  Place place = Find(now);
  if (place.kind != Place::Kind::kNowhere || view_.holder >= 0) return place;
  if (const int other = RoomElsewhere({}); other >= 0) return At(other);
  return place;
}

Place SimulatedNode::Ask(Time now) {
  Place place = Find(now);
  if (place.kind == Place::Kind::kElsewhere) wanted_ = false;
  if (place.kind != Place::Kind::kNowhere) return place;
  const bool has_room = !draining_ && !full_;
  const bool is_held = view_.holder >= 0 || IsExpected(now);
  const bool waits = view_.reachable && (is_held || RoomElsewhere({}) < 0);
  if (!has_room || !(view_.may_take || waits)) return Propose(now);
  wanted_ = true;
  place.kind = Place::Kind::kPending;
  return place;
}

void SimulatedNode::Release() {
  asked_.reset();
  wanted_ = false;
  expected_until_ = Time{0};
}

void SimulatedNode::Begin(const Place& place, Time now) {
  is_here_ = true;
  epoch_ = place.epoch;
  served_until_ = place.until;
  newest_ = 0;
  resumed_at_.reset();
  const auto arrived = arrivals_.Take(kSubject, now);
  if (!arrived || arrived->state.publisher_session != kPublisherSession) return;
  newest_ = arrived->state.newest_sequence;
  resumed_at_ = newest_;
  state_is_whole_ = arrived->state.captures == TextOf(newest_);
  state_is_newest_ = newest_ >= newest_received_;
}

SimulatedNode::Answer SimulatedNode::Offer(Time now) {
  if (is_here_) return Answer::kAccepted;
  const Place place = Ask(now);
  waits_ = place.kind == Place::Kind::kPending;
  switch (place.kind) {
    case Place::Kind::kHere:
      if (closed_) return Answer::kRefused;
      asked_ = now;
      Begin(place, now);
      return Answer::kAccepted;
    case Place::Kind::kPending: asked_ = now; return Answer::kWaits;
    case Place::Kind::kElsewhere:
      others_->SendPublisher(index_, IndexOf(place.node.name));
      return Answer::kSentAway;
    case Place::Kind::kNowhere: break;
  }
  return Answer::kRefused;
}

bool SimulatedNode::AsksAgain(Time now) {
  if (!waits_ || Ask(now).kind != Place::Kind::kHere) return false;
  waits_ = false;
  return true;
}

std::optional<SimulatedNode::Used> SimulatedNode::UsePose(std::uint32_t sequence, Time now) {
  if (!is_here_ || now >= served_until_ || sequence <= newest_) return std::nullopt;
  newest_ = sequence;
  return Used{epoch_, resumed_at_.has_value()};
}

std::string SimulatedNode::Receive(const protocol::SubjectState& state,
                                   const protocol::MessageView& view, Time now) {
  if (is_here_) return {};  // an old copy
  if (!arrivals_.Add(state, view, now)) return "no memory";
  newest_received_ = std::max(newest_received_, state.newest_sequence);
  if (!draining_ && (!full_ || IsExpected(now)) && view_.may_take) {
    wanted_ = true;
    asked_ = now;
    expected_until_ = now + Coordinator::kExpected;
    return {};
  }
  arrivals_.Drop(kSubject);
  return "it takes nothing";
}

void SimulatedNode::Refresh(Time now) {
  arrivals_.Expire(now);
  if (!is_here_) {
    if (asked_ && now - *asked_ >= Places::kPatience) Release();
    return;
  }
  asked_.reset();
  Place place = Ask(now);
  if (place.kind == Place::Kind::kHere && !closed_) {
    epoch_ = place.epoch;
    served_until_ = place.until;
    return;
  }
  place = Foreign(now);
  if (place.kind != Place::Kind::kElsewhere) return;
  others_->SendPublisher(index_, IndexOf(place.node.name));
  is_here_ = false;
  Release();
}

void SimulatedNode::SendAllAway(Time now) {
  draining_ = closed_ = true;
  if (is_here_) {
    const Place place = SuccessorOf(kSubject, now, {});
    if (place.kind == Place::Kind::kElsewhere) {
      others_->SendPublisher(index_, IndexOf(place.node.name));
    }
  }
  served_until_ = std::min(served_until_, now);
  Release();
}

std::vector<std::string> SimulatedNode::SubjectNames() {
  return is_here_ ? std::vector<std::string>{kSubject} : std::vector<std::string>();
}

Place SimulatedNode::SuccessorOf(const std::string& /*subject*/, Time now,
                                 const std::set<std::string>& without) {
  if (!is_here_) return Nowhere("it has left");
  if (!closed_ && served_until_ - now < kLeast) return Nowhere("the store does not answer");
  Place place = Foreign(now);
  if (place.kind == Place::Kind::kElsewhere) return place;
  const int other = RoomElsewhere(without);
  return other < 0 ? Nowhere("no other node has room") : At(other);
}

bool SimulatedNode::WriteState(const std::string& /*subject*/, std::uint32_t number,
                               std::vector<std::uint8_t>& message) {
  if (!is_here_) return false;
  protocol::SubjectState state;
  state.subject = kSubject;
  state.publisher_session = kPublisherSession;
  state.newest_sequence = newest_;
  state.captures = TextOf(newest_);
  encoder_.Encode({.session = 1, .sequence = number}, state, message);
  return true;
}

Status SimulatedNode::HandOver(const std::string& subject, const NodeAddress& node,
                               std::uint32_t number, std::vector<std::uint8_t>& message, Time now) {
  if (!is_here_) return {StatusCode::kNotFound, "it has left"};
  if (served_until_ - now < kLeast) return {StatusCode::kUnavailable, "the store does not answer"};
  (void)WriteState(subject, number, message);
  const int heir = IndexOf(node.name);
  others_->SendPublisher(index_, heir);
  is_here_ = false;
  Release();
  next_heir_ = heir_ = heir;
  heir_until_ = now + Coordinator::kExpected;
  return {};
}

}  // namespace furrow::server::testing

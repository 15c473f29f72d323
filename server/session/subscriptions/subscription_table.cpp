// SPDX-License-Identifier: Apache-2.0
#include "server/session/subscriptions/subscription_table.h"

#include <algorithm>
#include <utility>

namespace furrow::server {

Subscription& SubscriptionTable::Add(Peer& peer, const protocol::Header& request,
                                     std::unique_ptr<Subscription> subscription) {
  // Never reused, unlike `id`: tickets of pictures and keys of queued frames outlive a
  // subscription.
  subscription->uid = next_uid_++;
  subscription->peer = &peer;
  subscription->id = NewId(peer);
  subscription->request_session = request.session;
  subscription->request_sequence = request.sequence;
  Subscription& added = *subscription;
  // Lack of memory leaves everything as it was.
  const auto by_uid = by_uid_.emplace(added.uid, std::move(subscription)).first;
  try {
    by_peer_[&peer].emplace(added.id, &added);
    (void)places_.Enter(peer.host);  // HasRoomFor() was true
  } catch (...) {
    Unlist(peer, added.id);
    by_uid_.erase(by_uid);
    throw;
  }
  ++peer.num_subscriptions;
  return added;
}

void SubscriptionTable::Erase(Subscription& subscription) {
  if (subscription.subject != nullptr) {
    std::erase(subscription.subject->subscriptions, &subscription);
    --subscription.peer->num_bound;
  }
  // A client must not receive frames of a subscription that it has ended.
  subscription.peer->link->DropFrames(subscription.uid);
  --subscription.peer->num_subscriptions;
  places_.Leave(subscription.peer->host);
  Unlist(*subscription.peer, subscription.id);
  by_uid_.erase(subscription.uid);
}

// Takes an id, if it is there, from the list of the peer.
void SubscriptionTable::Unlist(const Peer& peer, std::uint16_t id) {
  const auto of_peer = by_peer_.find(&peer);
  if (of_peer == by_peer_.end()) return;
  of_peer->second.erase(id);
  if (of_peer->second.empty()) by_peer_.erase(of_peer);
}

Subscription* SubscriptionTable::Find(std::uint64_t uid) const {
  const auto found = by_uid_.find(uid);
  return found == by_uid_.end() ? nullptr : found->second.get();
}

Subscription* SubscriptionTable::Find(const Peer& peer, std::uint16_t id) const {
  const auto of_peer = by_peer_.find(&peer);
  if (of_peer == by_peer_.end()) return nullptr;
  const auto found = of_peer->second.find(id);
  return found == of_peer->second.end() ? nullptr : found->second;
}

Subscription* SubscriptionTable::FindRepeated(const Peer& peer,
                                              const protocol::Header& request) const {
  const auto of_peer = by_peer_.find(&peer);
  if (of_peer == by_peer_.end()) return nullptr;
  for (const auto& [id, subscription] : of_peer->second) {
    if (subscription->request_session == request.session &&
        subscription->request_sequence == request.sequence) {
      return subscription;
    }
  }
  return nullptr;
}

std::vector<Subscription*> SubscriptionTable::Of(const Peer& peer) const {
  std::vector<Subscription*> selected;
  const auto of_peer = by_peer_.find(&peer);
  if (of_peer == by_peer_.end()) return selected;
  for (const auto& [id, subscription] : of_peer->second) selected.push_back(subscription);
  SortByRequest(&selected);
  return selected;
}

void SubscriptionTable::Attach(Subscription& subscription, Subject& subject) {
  if (subscription.subject == &subject) return;
  if (subscription.subject == nullptr) ++subscription.peer->num_bound;
  subscription.subject = &subject;
  subject.subscriptions.push_back(&subscription);
}

std::vector<Subscription*> SubscriptionTable::DetachAll(Subject& subject) {
  // Returned by value: the caller erases some of them, which changes the table.
  std::vector<Subscription*> detached = std::exchange(subject.subscriptions, {});
  for (Subscription* subscription : detached) {
    subscription->subject = nullptr;
    --subscription->peer->num_bound;
  }
  return detached;
}

void SubscriptionTable::SortByRequest(std::vector<Subscription*>* subscriptions) {
  std::ranges::sort(*subscriptions, {}, &Subscription::uid);
}

// Ids count up, so that late messages about an ended subscription rarely meet a new one. The loop
// ends, because limits.max_subscriptions is at most 65,535.
std::uint16_t SubscriptionTable::NewId(Peer& peer) const {
  do {
    ++peer.last_subscription;
  } while (peer.last_subscription == 0 || Find(peer, peer.last_subscription) != nullptr);
  return peer.last_subscription;
}

}  // namespace furrow::server

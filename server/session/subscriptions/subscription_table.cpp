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
  by_uid_.emplace(added.uid, std::move(subscription));
  ++peer.num_subscriptions;
  return added;
}

void SubscriptionTable::Erase(Subscription& subscription) {
  if (subscription.subject != nullptr) {
    std::erase(by_subject_[subscription.subject->id], &subscription);
  }
  // A client must not receive frames of a subscription that it has ended.
  subscription.peer->link->DropFrames(subscription.uid);
  --subscription.peer->num_subscriptions;
  by_uid_.erase(subscription.uid);
}

Subscription* SubscriptionTable::Find(std::uint64_t uid) const {
  const auto found = by_uid_.find(uid);
  return found == by_uid_.end() ? nullptr : found->second.get();
}

Subscription* SubscriptionTable::Find(const Peer& peer, std::uint16_t id) const {
  // A search through all subscriptions is fast enough: it serves requests, not poses.
  for (const auto& [uid, subscription] : by_uid_) {
    if (subscription->peer == &peer && subscription->id == id) return subscription.get();
  }
  return nullptr;
}

Subscription* SubscriptionTable::FindRepeated(const Peer& peer,
                                              const protocol::Header& request) const {
  // Saves the search for the many peers that only publish.
  if (peer.num_subscriptions == 0) return nullptr;
  for (const auto& [uid, subscription] : by_uid_) {
    if (subscription->peer == &peer && subscription->request_session == request.session &&
        subscription->request_sequence == request.sequence) {
      return subscription.get();
    }
  }
  return nullptr;
}

void SubscriptionTable::Attach(Subscription& subscription, Subject& subject) {
  if (subscription.subject == &subject) return;
  subscription.subject = &subject;
  by_subject_[subject.id].push_back(&subscription);
}

std::vector<Subscription*> SubscriptionTable::DetachAll(const Subject& subject) {
  const auto found = by_subject_.find(subject.id);
  if (found == by_subject_.end()) return {};
  // Returned by value: the caller erases some of them, which changes the table.
  std::vector<Subscription*> detached = std::move(found->second);
  by_subject_.erase(found);
  for (Subscription* subscription : detached) subscription->subject = nullptr;
  return detached;
}

std::span<Subscription* const> SubscriptionTable::Of(SubjectId subject) const {
  const auto found = by_subject_.find(subject);
  if (found == by_subject_.end()) return {};
  return found->second;
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

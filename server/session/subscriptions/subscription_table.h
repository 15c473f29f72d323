// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include "protocol/messages/messages.h"
#include "server/session/peers/peer.h"
#include "server/session/subjects/subject_registry.h"
#include "server/session/subscriptions/subscription.h"
#include "server/shares/fair_share.h"

namespace furrow::server {

// All subscriptions of a daemon, by uid. Keeps Subject::subscriptions, Peer::num_subscriptions and
// Peer::num_bound up to date. The address of a subscription is stable
// until Erase().
class SubscriptionTable {
 public:
  // `places`: for subscriptions, shared between hosts (FairShare), since a host may have many
  // peers.
  explicit SubscriptionTable(std::size_t places) : places_(places) {}

  // Changes the number of places. Subscriptions beyond it stay.
  void SetPlaces(std::size_t places) { places_.SetPlaces(places); }
  // False: the peer's host has its share of the subscriptions.
  [[nodiscard]] bool HasRoomFor(const Peer& peer) const { return places_.HasRoomFor(peer.host); }

  // Adds a subscription and sets its peer, uid and id. `request`: the header of the message.
  // Requires HasRoomFor(peer).
  Subscription& Add(Peer& peer, const protocol::Header& request,
                    std::unique_ptr<Subscription> subscription);
  // Destroys a subscription and drops its queued frames.
  void Erase(Subscription& subscription);

  // Null: no such subscription.
  [[nodiscard]] Subscription* Find(std::uint64_t uid) const;
  [[nodiscard]] Subscription* Find(const Peer& peer, std::uint16_t id) const;
  // The subscription that an earlier copy of this request created; null if there is none.
  [[nodiscard]] Subscription* FindRepeated(const Peer& peer, const protocol::Header& request) const;

  // Binds a subscription to a subject. Binding twice changes nothing.
  void Attach(Subscription& subscription, Subject& subject);
  // Unbinds all subscriptions of a subject that leaves, and returns them.
  [[nodiscard]] std::vector<Subscription*> DetachAll(Subject& subject);

  // The subscriptions of a peer, in the order of their requests.
  [[nodiscard]] std::vector<Subscription*> Of(const Peer& peer) const;
  // The subscriptions for which `matches` is true, in the order of their requests.
  template <class Predicate>
  [[nodiscard]] std::vector<Subscription*> Select(const Predicate& matches) const {
    std::vector<Subscription*> selected;
    for (const auto& [uid, subscription] : by_uid_) {
      if (matches(*subscription)) selected.push_back(subscription.get());
    }
    SortByRequest(&selected);
    return selected;
  }
  // Calls `function` for all subscriptions, in no particular order. It must not add or erase any.
  template <class Function>
  void ForEach(const Function& function) const {
    for (const auto& [uid, subscription] : by_uid_) function(*subscription);
  }
  [[nodiscard]] std::size_t size() const { return by_uid_.size(); }
  // Of all hosts: one per subscription.
  [[nodiscard]] std::size_t num_places_taken() const { return places_.taken(); }

 private:
  void Unlist(const Peer& peer, std::uint16_t id);
  static void SortByRequest(std::vector<Subscription*>* subscriptions);
  [[nodiscard]] std::uint16_t NewId(Peer& peer) const;

  std::unordered_map<std::uint64_t, std::unique_ptr<Subscription>> by_uid_;
  std::unordered_map<const Peer*, std::unordered_map<std::uint16_t, Subscription*>> by_peer_;
  FairShare places_;
  std::uint64_t next_uid_ = 1;
};

}  // namespace furrow::server

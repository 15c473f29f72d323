// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <unordered_map>
#include <utility>

#include "server/session/peers/peer.h"

namespace furrow::server {

// The peers of one shard. The address of a Peer is stable until Remove(). Table number `table` of
// `tables` tables assigns only ids with id % tables == table, so that an id identifies its table.
class PeerTable {
 public:
  explicit PeerTable(int table = 0, int tables = 1)
      : step_(static_cast<PeerId>(tables)), next_id_(step_ + static_cast<PeerId>(table)) {}

  // The number of the table that assigned the id.
  [[nodiscard]] static std::size_t TableOf(PeerId id, std::size_t tables) { return id % tables; }

  // Adds a peer with the next id. `link` must outlive the peer.
  Peer& Add(Transport transport, PeerLabel name, Link* link, TokenBucket bucket, Time now) {
    auto peer = std::make_unique<Peer>();
    peer->id = std::exchange(next_id_, next_id_ + step_);
    peer->transport = transport;
    peer->name = std::move(name.text);
    peer->host = std::move(name.host);
    peer->shielded = name.shielded;
    peer->address = std::move(name.address);
    peer->link = link;
    peer->bucket = bucket;
    peer->last_heard = peer->last_used = now;
    peer->consent.Begin(now);
    Peer& added = *peer;
    peers_.emplace(added.id, std::move(peer));
    return added;
  }
  // Null if there is no peer with this id.
  [[nodiscard]] Peer* Find(PeerId id) {
    const auto found = peers_.find(id);
    return found == peers_.end() ? nullptr : found->second.get();
  }
  void Remove(PeerId id) { peers_.erase(id); }

  template <class Function>
  void ForEach(Function function) {
    for (auto& [id, peer] : peers_) function(*peer);
  }
  [[nodiscard]] std::size_t size() const { return peers_.size(); }

 private:
  std::unordered_map<PeerId, std::unique_ptr<Peer>> peers_;
  const PeerId step_;
  PeerId next_id_;
};

}  // namespace furrow::server

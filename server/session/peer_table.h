// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <unordered_map>
#include <utility>

#include "server/session/peer.h"

namespace furrow::server {

// The peers of one network thread. A Peer's address is stable until Remove().
class PeerTable {
 public:
  Peer& Add(Transport transport, std::string name, Link* link, TokenBucket bucket, Time now) {
    auto peer = std::make_unique<Peer>();
    peer->id = next_id_++;
    peer->transport = transport;
    peer->name = std::move(name);
    peer->link = link;
    peer->bucket = bucket;
    peer->last_heard = now;
    Peer& added = *peer;
    peers_.emplace(added.id, std::move(peer));
    return added;
  }
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
  PeerId next_id_ = 1;
};

}  // namespace furrow::server

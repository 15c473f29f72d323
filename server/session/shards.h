// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "server/core/metrics.h"
#include "server/session/peers/peer_table.h"
#include "server/session/shard.h"
#include "server/session/shard_mutexes.h"
#include "server/session/stream_router.h"

namespace furrow::server {

// The shards of a hub and the locks that guard them. A peer belongs to one shard for life; its id
// names the shard.
class Shards {
 public:
  // `count` >= 1. `router` publishes what a shard has gathered before a lock is released.
  Shards(int count, std::uint64_t session, Metrics* metrics, StreamRouter* router);

  [[nodiscard]] Shard& at(int index) { return *shards_[static_cast<std::size_t>(index)]; }
  [[nodiscard]] Shard& Of(PeerId id) { return *shards_[PeerTable::TableOf(id, shards_.size())]; }
  // Null: the peer has left.
  [[nodiscard]] Peer* FindPeer(PeerId id) { return Of(id).peers.Find(id); }
  [[nodiscard]] std::size_t size() const { return shards_.size(); }
  // The peers of all shards. Requires the exclusive lock.
  template <class Function>
  void ForEachPeer(const Function& function) {
    for (const auto& shard : shards_) shard->peers.ForEach(function);
  }

  // Locks one shard for its own thread. When the outermost lock ends, the shard's gathered poses
  // are published and its buffered messages sent.
  class Lock {
   public:
    Lock(Shards& shards, int index);
    ~Lock();
    Lock(const Lock&) = delete;
    Lock& operator=(const Lock&) = delete;

   private:
    Shards& shards_;
    Shard& shard_;
  };
  // Locks the whole hub, from the thread of shard `index`, whether or not it holds that shard's
  // lock. Publishes and sends what the shard has gathered before any other thread may run. Nests.
  class ExclusiveLock {
   public:
    ExclusiveLock(Shards& shards, int index);
    ~ExclusiveLock();
    ExclusiveLock(const ExclusiveLock&) = delete;
    ExclusiveLock& operator=(const ExclusiveLock&) = delete;

   private:
    Shards& shards_;
    Shard& shard_;
  };

 private:
  void Flush(Shard& shard) noexcept;
  void PublishGathered(Shard& shard) noexcept;

  ShardMutexes mutexes_;
  std::vector<std::unique_ptr<Shard>> shards_;
  StreamRouter* const router_;
  Metrics* const metrics_;
};

}  // namespace furrow::server

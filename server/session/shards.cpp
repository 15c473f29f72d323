// SPDX-License-Identifier: Apache-2.0
#include "server/session/shards.h"

#include "server/core/within_memory.h"

namespace furrow::server {

Shards::Shards(int count, std::uint64_t session, Metrics* metrics, StreamRouter* router)
    : mutexes_(count), router_(router), metrics_(metrics) {
  for (int i = 0; i < count; ++i) {
    shards_.push_back(std::make_unique<Shard>(i, count, session, metrics));
  }
}

// Runs while locks change hands, so it must not throw: what memory does not suffice for is lost,
// like a datagram.
void Shards::Flush(Shard& shard) noexcept {
  WithinMemory(metrics_, [&shard] {
    if (shard.buffered_sender != nullptr) shard.buffered_sender->Flush();
  });
  router_->OnFlushed(shard);
}

void Shards::PublishGathered(Shard& shard) noexcept {
  WithinMemory(metrics_, [&] { router_->PublishGathered(shard); });
}

// The counters belong to the shard's thread, so reading them needs no lock. A shard lock inside an
// exclusive one already has the mutex.
Shards::Lock::Lock(Shards& shards, int index) : shards_(shards), shard_(shards.at(index)) {
  if (shard_.shard_locks++ == 0 && shard_.exclusive_locks == 0) {
    shards_.mutexes_.Lock(shard_.index);
  }
}

// Publishing comes before flushing, because it fills the sender, and both come before unlocking,
// because they use the shard and its subjects.
Shards::Lock::~Lock() {
  if (shard_.shard_locks == 1) {
    shards_.PublishGathered(shard_);
    shards_.Flush(shard_);
  }
  if (--shard_.shard_locks == 0 && shard_.exclusive_locks == 0) {
    shards_.mutexes_.Unlock(shard_.index);
  }
}

Shards::ExclusiveLock::ExclusiveLock(Shards& shards, int index)
    : shards_(shards), shard_(shards.at(index)) {
  // Outside of a shard lock nothing is gathered, so this touches the batch only under the lock.
  shards_.PublishGathered(shard_);
  // With one shard, one thread uses the hub (other threads post to its event loop), so there is
  // nobody to lock out.
  if (shard_.exclusive_locks++ > 0) return;
  if (shards_.size() == 1) {
    shards_.router_->SetExclusive(true);
    return;
  }
  if (shard_.shard_locks > 0) {
    // Give up the own shard first: two threads that each held their shard and waited for all others
    // would wait forever.
    // Another shard may publish the same subject as soon as this one is unlocked.
    shards_.Flush(shard_);
    shards_.mutexes_.Unlock(shard_.index);
  }
  shards_.mutexes_.LockAll();
  shards_.router_->SetExclusive(true);
}

Shards::ExclusiveLock::~ExclusiveLock() {
  if (--shard_.exclusive_locks > 0) return;
  shards_.router_->SetExclusive(false);
  const bool is_single = shards_.size() == 1;
  if (is_single && shard_.shard_locks > 0) return;  // the end of the shard lock flushes
  // Replies under the exclusive lock go to the sender of the receiving peer's shard, so all may
  // have messages.
  for (const auto& shard : shards_.shards_) shards_.Flush(*shard);
  if (is_single) return;
  if (shard_.shard_locks > 0) {
    shards_.mutexes_.UnlockAllExcept(shard_.index);
  } else {
    shards_.mutexes_.UnlockAll();
  }
}

}  // namespace furrow::server

// SPDX-License-Identifier: Apache-2.0
#include "server/session/shard_mutexes.h"

namespace furrow::server {

void ShardMutexes::Lock(int shard) {
  // Queue behind a thread that waits in LockAll(). The check is a hint: a relaxed load is enough,
  // since the mutex below does the synchronisation.
  if (num_waiting_.load(std::memory_order_relaxed) > 0) {
    const std::lock_guard queue(turnstile_);
  }
  gates_[static_cast<std::size_t>(shard)].mutex.lock();
}

void ShardMutexes::LockAll() {
  num_waiting_.fetch_add(1, std::memory_order_relaxed);
  turnstile_.lock();
  for (Gate& gate : gates_) gate.mutex.lock();
  num_waiting_.fetch_sub(1, std::memory_order_relaxed);
}

void ShardMutexes::UnlockAll() {
  for (Gate& gate : gates_) gate.mutex.unlock();
  turnstile_.unlock();
}

void ShardMutexes::UnlockAllExcept(int shard) {
  for (std::size_t i = 0; i < gates_.size(); ++i) {
    if (i != static_cast<std::size_t>(shard)) gates_[i].mutex.unlock();
  }
  turnstile_.unlock();
}

}  // namespace furrow::server

// SPDX-License-Identifier: Apache-2.0
#include "server/session/shard_mutexes.h"

namespace furrow::server {

void ShardMutexes::Lock(int shard) {
  // Queue behind a thread that waits in LockAll(). The check is a hint: a relaxed load is enough,
  // since the mutex below does the synchronisation.
  if (num_waiting_.load(std::memory_order_relaxed) > 0) {
    const std::lock_guard queue(turnstile_);
  }
  // std::mutex is not fair: without the queue, a shard that unlocks and locks in a tight loop could
  // keep its mutex from a thread in LockAll() for a long time.
  gates_[static_cast<std::size_t>(shard)].mutex.lock();
}

// Only one thread at a time locks the gates, since it holds the turnstile, and it holds no gate
// when it starts. So two threads cannot wait for each other's gate.
void ShardMutexes::LockAll() {
  num_waiting_.fetch_add(1, std::memory_order_relaxed);
  turnstile_.lock();
  for (Gate& gate : gates_) gate.mutex.lock();
  // All gates are locked: other threads now wait at their own gate and need no queue.
  num_waiting_.fetch_sub(1, std::memory_order_relaxed);
}

void ShardMutexes::UnlockAll() {
  for (Gate& gate : gates_) gate.mutex.unlock();
  turnstile_.unlock();
}

// For an exclusive lock inside a shard lock, which stays in force. Keeping the gate, instead of
// locking it again, lets no other thread in between the two.
void ShardMutexes::UnlockAllExcept(int shard) {
  for (std::size_t i = 0; i < gates_.size(); ++i) {
    if (i != static_cast<std::size_t>(shard)) gates_[i].mutex.unlock();
  }
  turnstile_.unlock();
}

}  // namespace furrow::server

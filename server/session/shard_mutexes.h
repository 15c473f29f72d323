// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <mutex>
#include <vector>

namespace furrow::server {

// One mutex per shard; exclusive access takes all of them. Locking a shard touches no memory of
// other shards, so frequent work (poses) is cheap and rare work (subscriptions, the tick) pays.
//
// A thread that waits for exclusive access goes before threads that lock a shard again, so busy
// shards cannot starve it. The mutexes are not recursive.
class ShardMutexes {
 public:
  // `num_shards` >= 1.
  explicit ShardMutexes(int num_shards) : gates_(static_cast<std::size_t>(num_shards)) {}

  // Locks one shard, in [0, num_shards). Blocks while another thread holds or awaits all shards.
  void Lock(int shard);
  void Unlock(int shard) { gates_[static_cast<std::size_t>(shard)].mutex.unlock(); }
  // Locks all shards. The caller must not hold a shard.
  void LockAll();
  void UnlockAll();
  // Gives up exclusive access but keeps one shard locked.
  void UnlockAllExcept(int shard);

 private:
  struct alignas(64) Gate {  // a cache line each
    std::mutex mutex;
  };
  std::vector<Gate> gates_;
  std::mutex turnstile_;              // held by the thread with exclusive access
  std::atomic<int> num_waiting_ = 0;  // threads in LockAll()
};

}  // namespace furrow::server

// SPDX-License-Identifier: Apache-2.0
#include "server/session/shard_mutexes.h"

#include <array>
#include <atomic>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace furrow::server {
namespace {

constexpr int kShards = 3;
constexpr int kRounds = 2000;

TEST(ShardMutexes, LockAllExcludesAllShards) {
  ShardMutexes mutexes(kShards);
  std::array<int, kShards> written{};  // by the shard's thread, and under LockAll()
  std::atomic<int> inside = 0;
  std::vector<std::jthread> threads;
  for (int shard = 0; shard < kShards; ++shard) {
    threads.emplace_back([&, shard] {
      for (int i = 0; i < kRounds; ++i) {
        mutexes.Lock(shard);
        ++inside;
        ++written[static_cast<std::size_t>(shard)];
        --inside;
        mutexes.Unlock(shard);
        if (i % 7 != 0) continue;
        mutexes.LockAll();
        EXPECT_EQ(inside, 0);
        for (int& each : written) ++each;
        mutexes.UnlockAll();
      }
    });
  }
  threads.clear();
  const int num_exclusive = kShards * ((kRounds + 6) / 7);
  for (const int each : written) EXPECT_EQ(each, kRounds + num_exclusive);
}

TEST(ShardMutexes, ShardsLockIndependently) {
  ShardMutexes mutexes(2);
  mutexes.Lock(0);
  std::jthread([&] {
    mutexes.Lock(1);
    mutexes.Unlock(1);
  }).join();
  mutexes.Unlock(0);
}

TEST(ShardMutexes, UnlockAllExceptKeepsOneShardLocked) {
  ShardMutexes mutexes(2);
  mutexes.LockAll();
  mutexes.UnlockAllExcept(0);
  std::jthread([&] {
    mutexes.Lock(1);
    mutexes.Unlock(1);
  }).join();
  std::atomic<bool> has_locked_all = false;
  std::jthread other([&] {
    mutexes.LockAll();
    has_locked_all = true;
    mutexes.UnlockAll();
  });
  EXPECT_FALSE(has_locked_all) << "while shard 0 is locked";
  mutexes.Unlock(0);
  other.join();
  EXPECT_TRUE(has_locked_all);
}

// At least one of the two shards is locked at almost any moment.
TEST(ShardMutexes, BusyShardsDoNotStarveLockAll) {
  ShardMutexes mutexes(2);
  std::atomic<bool> done = false;
  std::vector<std::jthread> busy;
  for (int shard = 0; shard < 2; ++shard) {
    busy.emplace_back([&, shard] {
      while (!done) {
        mutexes.Lock(shard);
        mutexes.Unlock(shard);
      }
    });
  }
  for (int i = 0; i < 100; ++i) {
    mutexes.LockAll();
    mutexes.UnlockAll();
  }
  done = true;
}

}  // namespace
}  // namespace furrow::server

// SPDX-License-Identifier: Apache-2.0
#include "base/process/memory_reserve.h"

#include <cstdlib>
#include <fstream>
#include <memory>
#include <new>
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

namespace furrow {
namespace {

constexpr std::size_t kMebibyte = std::size_t{1} << 20;

TEST(MemoryReserve, IsFullWhereThereIsMemory) {
  (void)MemoryReserve::Refill();
  EXPECT_EQ(MemoryReserve::Refill(), 0u);
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
// Like the destructor of a JSON array.
struct Allocates {
  bool* ended;
  ~Allocates() {
    const std::vector<char> stack(kMebibyte);
    *ended = !stack.empty();
  }
};

// Bytes that this process has mapped.
rlim_t AddressSpace() {
  std::ifstream statm("/proc/self/statm");
  rlim_t pages = 0;
  statm >> pages;
  return pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
}

// Exit codes: 0 if everything is as the class says.
void RunOutOfMemory() {
  MemoryReserve::Install();
  std::vector<std::unique_ptr<char[]>> held;
  held.reserve(10'000);
  rlimit room{};
  if (getrlimit(RLIMIT_AS, &room) != 0) std::_Exit(2);
  room.rlim_cur = AddressSpace();
  if (setrlimit(RLIMIT_AS, &room) != 0) std::_Exit(3);
  bool cleared_up = false;
  try {
    const Allocates interrupted{&cleared_up};
    while (held.size() < held.capacity()) held.push_back(std::make_unique<char[]>(kMebibyte));
    std::_Exit(4);
  } catch (const std::bad_alloc&) {
  }
  if (!cleared_up) std::_Exit(5);
  // Each chunk of the first half is large enough for one of these.
  if (held.size() < MemoryReserve::kChunks / 2) std::_Exit(6);
  if (MemoryReserve::Refill() <= MemoryReserve::kChunks / 2) std::_Exit(7);
  try {
    held.push_back(std::make_unique<char[]>(16 * kMebibyte));
    std::_Exit(8);
  } catch (const std::bad_alloc&) {
  }
  room.rlim_cur = room.rlim_max;
  if (setrlimit(RLIMIT_AS, &room) != 0) std::_Exit(9);
  (void)MemoryReserve::Refill();
  const auto plenty = std::make_unique<char[]>(16 * kMebibyte);
  std::_Exit(plenty != nullptr && MemoryReserve::Refill() == 0 ? 0 : 10);
}
#endif

TEST(MemoryReserveDeathTest, WhatLackOfMemoryInterruptsIsDestroyed) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers need address space";
#else
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(RunOutOfMemory(), testing::ExitedWithCode(0), "");
#endif
}

}  // namespace
}  // namespace furrow

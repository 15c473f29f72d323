// SPDX-License-Identifier: Apache-2.0
#include "base/process/memory_reserve.h"

#include <cstdlib>
#include <fstream>
#include <latch>
#include <memory>
#include <new>
#include <optional>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include "tests/sanitizers.h"

namespace furrow {
namespace {

TEST(MemoryReserve, DoesNothingUnlessItIsInstalled) {
  EXPECT_EQ(MemoryReserve::Refill(), 0u);
  EXPECT_FALSE(MemoryReserve::IsShort());
}

constexpr std::size_t kMebibyte = std::size_t{1} << 20;
constexpr std::size_t kThird = MemoryReserve::kChunks / 3;

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

// Installs the reserve, and leaves no other memory.
rlimit Limit() {
  MemoryReserve::Install();
  rlimit room{};
  if (getrlimit(RLIMIT_AS, &room) != 0) std::_Exit(20);
  rlimit limited = room;
  limited.rlim_cur = AddressSpace();
  if (setrlimit(RLIMIT_AS, &limited) != 0) std::_Exit(21);
  return room;
}

using Held = std::vector<std::unique_ptr<char[]>>;

// Allocates until that fails.
void Exhaust(Held* held) {
  try {
    while (held->size() < held->capacity()) held->push_back(std::make_unique<char[]>(kMebibyte));
    std::_Exit(22);
  } catch (const std::bad_alloc&) {
  }
}

// The functions below end the process, with 0 if everything is as the class says.

void InterruptSomething() {
  Held held;
  held.reserve(10'000);
  (void)Limit();
  bool cleared_up = false;
  try {
    const Allocates interrupted{&cleared_up};
    while (held.size() < held.capacity()) held.push_back(std::make_unique<char[]>(kMebibyte));
    std::_Exit(1);
  } catch (const std::bad_alloc&) {
  }
  if (!cleared_up) std::_Exit(2);
  // Each chunk of the first third is large enough for one of these.
  if (held.size() < kThird) std::_Exit(3);
  std::_Exit(MemoryReserve::Refill() > kThird ? 0 : 4);
}

void DestroyWhatSucceeded() {
  Held held;
  held.reserve(10'000);
  std::latch limited(1);
  std::thread other([&] {
    limited.wait();
    Exhaust(&held);
  });
  (void)Limit();
  bool cleared_up = false;
  {
    const MemoryReserve::Scope scope;
    std::optional<Allocates> succeeded(std::in_place, &cleared_up);
    limited.count_down();
    other.join();  // it has taken all that there is for everybody
    if (!MemoryReserve::IsShort()) std::_Exit(1);
    if (MemoryReserve::Refill() != kThird) std::_Exit(2);
    succeeded.reset();
  }
  std::_Exit(cleared_up ? 0 : 3);
}

void GetMemoryAgain() {
  Held held;
  held.reserve(10'000);
  const rlimit room = Limit();
  Exhaust(&held);
  if (!MemoryReserve::IsShort()) std::_Exit(1);
  if (setrlimit(RLIMIT_AS, &room) != 0) std::_Exit(2);
  if (MemoryReserve::Refill() < kThird) std::_Exit(3);
  if (MemoryReserve::IsShort()) std::_Exit(4);
  const auto plenty = std::make_unique<char[]>(64 * kMebibyte);
  std::_Exit(plenty != nullptr && MemoryReserve::Refill() == 0 ? 0 : 5);
}

void StartWithASmallStack() {
  rlimit stack{};
  if (getrlimit(RLIMIT_STACK, &stack) != 0) std::_Exit(1);
  stack.rlim_cur = MemoryReserve::kStackBytes;
  if (setrlimit(RLIMIT_STACK, &stack) != 0) std::_Exit(2);
  MemoryReserve::Install();
  std::_Exit(0);
}

class MemoryReserveDeathTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!kLimitsMemory) GTEST_SKIP() << "sanitizers need address space";
    // In a new process: this one may have free memory of its own.
    GTEST_FLAG_SET(death_test_style, "threadsafe");
  }
};

TEST_F(MemoryReserveDeathTest, WhatLackOfMemoryInterruptsIsDestroyed) {
  EXPECT_EXIT(InterruptSomething(), testing::ExitedWithCode(0), "");
}

TEST_F(MemoryReserveDeathTest, WhatSucceededIsDestroyedInAScope) {
  EXPECT_EXIT(DestroyWhatSucceeded(), testing::ExitedWithCode(0), "");
}

TEST_F(MemoryReserveDeathTest, IsFilledUpWhenThereIsMemoryAgain) {
  EXPECT_EXIT(GetMemoryAgain(), testing::ExitedWithCode(0), "");
}

TEST_F(MemoryReserveDeathTest, ASmallStackIsNotMapped) {
  EXPECT_EXIT(StartWithASmallStack(), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace furrow

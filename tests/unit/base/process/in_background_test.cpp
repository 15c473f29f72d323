// SPDX-License-Identifier: Apache-2.0
#include "base/process/in_background.h"

#include <cstdlib>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>
#include <sys/resource.h>

#include "tests/sanitizers.h"

namespace furrow {
namespace {

TEST(InBackground, RunsOnAThreadOfItsOwn) {
  const auto here = std::this_thread::get_id();
  EXPECT_NE(InBackground([] { return std::this_thread::get_id(); }).get(), here);
}

TEST(InBackground, ANicenessIsOfTheThreadAlone) {
  const int here = getpriority(PRIO_PROCESS, 0);
  EXPECT_EQ(InBackground(19, [] { return getpriority(PRIO_PROCESS, 0); }).get(), 19);
  EXPECT_EQ(getpriority(PRIO_PROCESS, 0), here);
}

TEST(InBackground, PassesExceptionsOn) {
  auto failed = InBackground([]() -> int { throw std::runtime_error("broken"); });
  EXPECT_THROW(failed.get(), std::runtime_error);
}

// Leaves no address space for the stack of a thread. Exit codes: 0 if the task ran here.
void RunWithoutThreads() {
  const rlimit none{1, 1};
  if (setrlimit(RLIMIT_AS, &none) != 0) std::_Exit(2);
  const auto here = std::this_thread::get_id();
  auto done = InBackground([here] { return std::this_thread::get_id() == here; });
  std::_Exit(done.get() ? 0 : 1);
}

TEST(InBackgroundDeathTest, RunsAtOnceWhereNoThreadMayStart) {
  if (!kLimitsMemory) GTEST_SKIP() << "sanitizers need address space";
  // In a new process: this one may have the stacks of threads that have ended.
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(RunWithoutThreads(), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace furrow

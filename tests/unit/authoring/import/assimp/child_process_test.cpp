// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/assimp/child_process.h"

#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace furrow::authoring {
namespace {

TEST(Confined, ReturnsTheResult) {
  const std::string long_text(3u << 20, 'a');
  const auto result =
      RunInChildProcess({}, [&]() -> Result<std::string> { return long_text + "b"; });
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(*result, long_text + "b");
}

TEST(Confined, ReturnsErrorsUnchanged) {
  const auto result = RunInChildProcess({}, []() -> Result<std::string> {
    return Status(StatusCode::kUnsupported, "what", "where", "todo");
  });
  EXPECT_EQ(result.status().code(), StatusCode::kUnsupported);
  EXPECT_EQ(result.status().ToString(), "where: what (todo)");
}

TEST(Confined, DoesNotAffectTheParentProcess) {
  int value = 1;
  ASSERT_TRUE(RunInChildProcess({}, [&]() -> Result<std::string> {
                value = 2;
                return std::string();
              }).ok());
  EXPECT_EQ(value, 1);
}

TEST(Confined, CrashIsAParseError) {
  const auto result = RunInChildProcess({}, []() -> Result<std::string> {
    std::signal(SIGSEGV, SIG_DFL);
    std::raise(SIGSEGV);
    return std::string();
  });
  EXPECT_EQ(result.status().code(), StatusCode::kParse);
}

TEST(Confined, ExceptionIsAParseError) {
  const auto result =
      RunInChildProcess({}, []() -> Result<std::string> { throw std::runtime_error("odd"); });
  EXPECT_EQ(result.status().code(), StatusCode::kParse);
  EXPECT_EQ(result.status().what(), "odd");
}

TEST(Confined, EndlessWorkIsALimit) {
  const auto result = RunInChildProcess({.max_cpu_seconds = 1}, []() -> Result<std::string> {
    for (volatile int i = 0;; i = i + 1) {
    }
  });
  EXPECT_EQ(result.status().code(), StatusCode::kLimit);
}

TEST(Confined, OversizedResultIsALimit) {
  const auto result = RunInChildProcess({.max_result_bytes = 100}, []() -> Result<std::string> {
    return std::string(1u << 20, 'x');
  });
  EXPECT_EQ(result.status().code(), StatusCode::kLimit);
}

}  // namespace
}  // namespace furrow::authoring

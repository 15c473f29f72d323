// SPDX-License-Identifier: Apache-2.0
#include "base/process/limited_process.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/sanitizers.h"

namespace furrow {
namespace {

using ::testing::HasSubstr;

Result<std::string> Shell(const std::string& script, std::string_view input = {},
                          const ProcessLimits& limits = {}) {
  return RunLimited("/bin/sh", std::vector<std::string>{"-c", script}, input, limits);
}

TEST(LimitedProcess, ReturnsTheOutput) {
  const std::string input(3u << 20, 'a');
  const auto output = Shell("cat; printf b", input);
  ASSERT_TRUE(output.ok()) << output.status().ToString();
  EXPECT_EQ(*output, input + "b");
}

TEST(LimitedProcess, ProgramNeedNotReadItsInput) {
  const auto output = Shell("exec <&-; printf b", std::string(3u << 20, 'a'));
  ASSERT_TRUE(output.ok()) << output.status().ToString();
  EXPECT_EQ(*output, "b");
}

TEST(LimitedProcess, InheritsOnlyTheStandardDescriptors) {
  // `ls` opens the folder that it lists as descriptor 3.
  const auto output = Shell("cat >/dev/null; ls /proc/self/fd; pwd");
  ASSERT_TRUE(output.ok()) << output.status().ToString();
  EXPECT_EQ(*output, "0\n1\n2\n3\n/\n");
}

TEST(LimitedProcess, FailureShowsTheLastLineOfStandardError) {
  const auto output = Shell("echo one >&2; echo two >&2; exit 3");
  EXPECT_EQ(output.status().code(), StatusCode::kIo);
  EXPECT_THAT(output.status().what(), HasSubstr("exit code 3: two"));
}

TEST(LimitedProcess, CrashIsAParseError) {
  EXPECT_EQ(Shell("kill -SEGV $$").status().code(), StatusCode::kParse);
}

TEST(LimitedProcess, EndlessWorkIsALimit) {
  const auto output = Shell("cat >/dev/null; while :; do :; done", {}, {.max_cpu_seconds = 1});
  EXPECT_EQ(output.status().code(), StatusCode::kLimit);
  EXPECT_THAT(output.status().what(), HasSubstr("1 s of processor time"));
}

TEST(LimitedProcess, WaitingForeverIsALimit) {
  const auto output = Shell("read line; sleep 1000", {}, {.max_seconds = 1});
  EXPECT_EQ(output.status().code(), StatusCode::kLimit);
  EXPECT_THAT(output.status().what(), HasSubstr("more than 1 s"));
}

TEST(LimitedProcess, ProgramThatNeverReadsIsALimit) {
  const auto output = Shell("sleep 1000", std::string(3u << 20, 'a'), {.max_seconds = 1});
  EXPECT_EQ(output.status().code(), StatusCode::kLimit);
}

TEST(LimitedProcess, OversizedOutputIsALimit) {
  const auto output = Shell("exec cat", std::string(1u << 20, 'x'), {.max_output_bytes = 4096});
  EXPECT_EQ(output.status().code(), StatusCode::kLimit);
}

TEST(LimitedProcess, MemoryAndCoreAreLimited) {
  if (!kLimitsMemory) GTEST_SKIP() << "memory is not limited under sanitizers";
  const auto output = Shell("cat >/dev/null; ulimit -v; ulimit -c", {},
                            {.max_memory_bytes = std::size_t{256} << 20});
  ASSERT_TRUE(output.ok()) << output.status().ToString();
  EXPECT_EQ(*output, "262144\n0\n");
}

TEST(LimitedProcess, MissingProgramIsAnError) {
  const auto output = RunLimited("/nowhere/program", {}, {});
  EXPECT_EQ(output.status().code(), StatusCode::kIo);
  EXPECT_THAT(output.status().ToString(), HasSubstr("/nowhere/program"));
}

}  // namespace
}  // namespace furrow

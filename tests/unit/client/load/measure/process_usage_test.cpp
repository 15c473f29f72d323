// SPDX-License-Identifier: Apache-2.0
#include "client/load/measure/process_usage.h"

#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/temporary_folder.h"

namespace furrow::load {
namespace {

namespace fs = std::filesystem;

// A fake /proc with two threads and one socket.
class ProcTest : public testing::Test {
 protected:
  void SetUp() override {
    Write(
        "net/udp",
        "  sl  local_address rem_address   st ...\n"
        "  1: 0100007F:1CE9 00000000:0000 07 00000000:00000000 00:00000000 00000000  0 0 4711 2\n"
        "  2: 0100007F:1CEA 00000000:0000 07 00000000:00000000 00:00000000 00000000  0 0 4712 2\n");
    Write("net/tcp6",
          "  sl  local_address rem_address   st ...\n"
          "  1: 00000000000000000000000001000000:1CE8 00000000000000000000000000000000:0000 01 "
          "00000000:00000000 00:00000000 00000000  0 0 99 2\n"
          "  2: 00000000000000000000000001000000:1CE8 00000000000000000000000000000000:0000 0A "
          "00000000:00000000 00:00000000 00000000  0 0 98 2\n");
    Write("42/status", "Name:\tfurrowd\nVmHWM:\t   2048 kB\nVmRSS:\t   1024 kB\n");
    Write("42/task/42/schedstat", "1500000000 5 6\n");
    Write("42/task/43/schedstat", "500000000 5 6\n");
    fs::create_directories(proc_ / "42/fd");
    fs::create_symlink("socket:[4711]", proc_ / "42/fd/3");
    fs::create_directories(proc_ / "43/fd");
    fs::create_symlink("socket:[98]", proc_ / "43/fd/3");
  }
  void Write(const std::string& name, const std::string& text) {
    fs::create_directories((proc_ / name).parent_path());
    std::ofstream(proc_ / name) << text;
  }
  const TemporaryFolder folder_;
  const fs::path proc_ = folder_.path();
};

TEST_F(ProcTest, AddsUpThreadsAndReadsMemory) {
  const auto usage = ReadUsage(42, proc_);
  ASSERT_TRUE(usage);
  EXPECT_DOUBLE_EQ(usage->cpu_seconds, 2.0);
  EXPECT_EQ(usage->resident_bytes, 1024u * 1024u);
  EXPECT_EQ(usage->peak_resident_bytes, 2048u * 1024u);
  EXPECT_FALSE(ReadUsage(44, proc_));
}

TEST_F(ProcTest, FindsTheOwnerOfAPort) {
  EXPECT_EQ(FindPortOwner("udp", 0x1CE9, proc_), 42);
  EXPECT_EQ(FindPortOwner("tcp", 0x1CE8, proc_), 43);  // the listener and not the connection
  EXPECT_EQ(FindPortOwner("udp", 0x1CEA, proc_), std::nullopt);  // owned by no visible process
  EXPECT_EQ(FindPortOwner("udp", 0x1CEB, proc_), std::nullopt);
}

TEST(ReadUsage, ReadsThisProcess) {
  const auto usage = ReadUsage(getpid());
  ASSERT_TRUE(usage);
  EXPECT_GT(usage->resident_bytes, 100'000u);
  EXPECT_GE(usage->peak_resident_bytes, usage->resident_bytes);
}

}  // namespace
}  // namespace furrow::load

// SPDX-License-Identifier: Apache-2.0
#include "server/machine/process_stats.h"

#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace furrow::server {
namespace {

TEST(ReadProcessStats, CountsWhatThisProcessUses) {
  const ProcessStats before = ReadProcessStats();
  EXPECT_GT(before.cpu_seconds, 0.0);
  EXPECT_GE(before.threads, 1u);
  EXPECT_GT(before.max_files, before.open_files);
  EXPECT_GT(before.resident_bytes, 0u);
  EXPECT_GE(before.virtual_bytes, before.resident_bytes);
  std::vector<int> files;
  for (int i = 0; i < 5; ++i) files.push_back(open("/dev/null", O_RDONLY | O_CLOEXEC));
  EXPECT_EQ(ReadProcessStats().open_files, before.open_files + 5);
  for (const int file : files) close(file);
}

}  // namespace
}  // namespace furrow::server

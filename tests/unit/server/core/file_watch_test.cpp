// SPDX-License-Identifier: Apache-2.0
#include "server/core/file_watch.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "base/files.h"

namespace furrow::server {
namespace {

TEST(FileWatch, NoticesThatAFileWasWrittenOrReplaced) {
  const auto path = std::filesystem::path(testing::TempDir()) / "file_watch_test";
  std::filesystem::remove(path);
  FileWatch watch(path);
  EXPECT_FALSE(watch.Changed()) << "absent";
  ASSERT_TRUE(WriteFileAtomically(path, "one").ok());
  EXPECT_TRUE(watch.Changed());
  EXPECT_FALSE(watch.Changed());
  ASSERT_TRUE(WriteFileAtomically(path, "two").ok());
  EXPECT_TRUE(watch.Changed()) << "of the same size, perhaps in the same instant";
  std::filesystem::remove(path);
  EXPECT_FALSE(watch.Changed()) << "somebody may be replacing it";
  EXPECT_FALSE(FileWatch({}).Changed());
}

}  // namespace
}  // namespace furrow::server

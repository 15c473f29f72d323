// SPDX-License-Identifier: Apache-2.0
#include "base/data_dir.h"

#include <gtest/gtest.h>

namespace furrow {
namespace {

TEST(InstallPrefix, IsAboveTheFoldersOfPrograms) {
  EXPECT_EQ(InstallPrefix("/opt/furrow/bin"), "/opt/furrow");
  EXPECT_EQ(InstallPrefix("/opt/furrow/libexec/furrow"), "/opt/furrow");
  EXPECT_EQ(InstallPrefix("/usr/libexec/furrow"), "/usr");
  EXPECT_EQ(InstallPrefix("/home/furrow/bin"), "/home/furrow");
}

TEST(InstallPrefix, IsTheFolderOfThisBuild) {
  EXPECT_TRUE(std::filesystem::equivalent(InstallPrefix(), FURROW_BINARY_DIR));
}

}  // namespace
}  // namespace furrow

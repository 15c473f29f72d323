// SPDX-License-Identifier: Apache-2.0
#include "client/cli/authoring/staged_folder.h"

#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "tests/temporary_folder.h"

namespace furrow::cli {
namespace {

namespace fs = std::filesystem;

class StagedFolderTest : public testing::Test {
 protected:
  static void Put(const fs::path& path, const std::string& text) { std::ofstream(path) << text; }
  static std::string Text(const fs::path& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
  }
  [[nodiscard]] std::size_t Entries() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(root_.path()), {}));
  }

  TemporaryFolder root_;
};

TEST_F(StagedFolderTest, FilesAppearOnlyAfterCommit) {
  {
    auto folder = StagedFolder::Create(root_ / "out");
    ASSERT_TRUE(folder.ok());
    ASSERT_TRUE(folder->Write("a", "1").ok());
    EXPECT_FALSE(fs::exists(root_ / "out"));
  }
  EXPECT_EQ(Entries(), 0u);
}

TEST_F(StagedFolderTest, ReplacesFilesAndKeepsOtherFiles) {
  fs::create_directories(root_ / "out");
  Put(root_ / "out/a", "old");
  Put(root_ / "out/other", "mine");
  {
    auto folder = StagedFolder::Create(root_ / "out");
    ASSERT_TRUE(folder.ok());
    ASSERT_TRUE(folder->Write("a", "new").ok());
    ASSERT_TRUE(folder->Write("deep/b", "new").ok());
    ASSERT_TRUE(folder->Commit().ok());
  }
  EXPECT_EQ(Text(root_ / "out/a"), "new");
  EXPECT_EQ(Text(root_ / "out/deep/b"), "new");
  EXPECT_EQ(Text(root_ / "out/other"), "mine");
  EXPECT_EQ(Entries(), 1u);
}

TEST_F(StagedFolderTest, AnErrorLeavesTheFolderUnchanged) {
  fs::create_directories(root_ / "out/c/in the way");
  for (const char* name : {"a", "b", "d"}) Put(root_ / "out" / name, "old");
  {
    auto folder = StagedFolder::Create(root_ / "out");
    ASSERT_TRUE(folder.ok());
    for (const char* name : {"a", "b", "c", "d", "e"}) ASSERT_TRUE(folder->Write(name, "new").ok());
    const Status failed = folder->Commit();
    EXPECT_EQ(failed.code(), StatusCode::kIo);
    EXPECT_NE(failed.where().find("out/c"), std::string::npos);
  }
  for (const char* name : {"a", "b", "d"}) EXPECT_EQ(Text(root_ / "out" / name), "old") << name;
  EXPECT_FALSE(fs::exists(root_ / "out/e"));
  EXPECT_TRUE(fs::is_directory(root_ / "out/c/in the way"));
  EXPECT_EQ(Entries(), 1u);
}

}  // namespace
}  // namespace furrow::cli

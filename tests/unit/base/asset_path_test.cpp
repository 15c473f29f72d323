// SPDX-License-Identifier: Apache-2.0
#include "base/asset_path.h"

#include <cstdlib>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "tests/temporary_folder.h"

namespace furrow::character {
namespace {

namespace fs = std::filesystem;

class AssetPath : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const char* folder : {"beside", "first", "second"}) fs::create_directories(root_ / folder);
    setenv("FURROW_ASSET_PATH",
           ((root_ / "first").string() + "::" + (root_ / "second").string()).c_str(), 1);
  }
  void TearDown() override { unsetenv("FURROW_ASSET_PATH"); }
  void Touch(const fs::path& name) { ASSERT_TRUE(WriteFileAtomically(root_ / name, "x").ok()); }

  TemporaryFolder root_;
};

TEST_F(AssetPath, LooksBesideThenAlongThePath) {
  Touch("second/a.png");
  EXPECT_EQ(*FindAsset("a.png", root_ / "beside"), root_ / "second/a.png");
  Touch("first/a.png");
  EXPECT_EQ(*FindAsset("a.png", root_ / "beside"), root_ / "first/a.png");
  Touch("beside/a.png");
  EXPECT_EQ(*FindAsset("a.png", root_ / "beside"), root_ / "beside/a.png");
}

TEST_F(AssetPath, ListsWhereItLooked) {
  const Status status = FindAsset("b.png", root_ / "beside").status();
  EXPECT_EQ(status.code(), StatusCode::kNotFound);
  for (const char* folder : {"beside", "first", "second"}) {
    EXPECT_THAT(status.what(), ::testing::HasSubstr((root_ / folder).string()));
  }
}

TEST_F(AssetPath, StaysInsideItsFolders) {
  Touch("secret");
  for (const char* name :
       {"", "/etc/passwd", "../secret", "a/../../secret", "a\\b", "C:b", "a\nb"}) {
    EXPECT_EQ(FindAsset(name, root_ / "beside").status().code(), StatusCode::kInvalidArgument)
        << name;
  }
  EXPECT_EQ(CheckAssetName(std::string(2000, 'a')).code(), StatusCode::kLimit);
  EXPECT_TRUE(CheckAssetName("textures/skin..v2.png").ok());
}

TEST_F(AssetPath, ReadsWithinALimit) {
  ASSERT_TRUE(WriteFileAtomically(root_ / "f", "12345").ok());
  EXPECT_EQ(*ReadFile(root_ / "f", 5), "12345");
  EXPECT_EQ(ReadFile(root_ / "f", 4).status().code(), StatusCode::kLimit);
  EXPECT_EQ(ReadFile(root_ / "g", 4).status().code(), StatusCode::kNotFound);
  EXPECT_EQ(ReadFile(root_.path(), 4).status().code(), StatusCode::kIo);
}

TEST_F(AssetPath, WritesAllOrNothing) {
  ASSERT_TRUE(WriteFileAtomically(root_ / "f", "old").ok());
  ASSERT_TRUE(WriteFileAtomically(root_ / "f", "new").ok());
  EXPECT_EQ(*ReadFile(root_ / "f", 10), "new");
  const Status status = WriteFileAtomically(root_ / "no/such/folder/f", "x");
  EXPECT_EQ(status.code(), StatusCode::kIo);
  EXPECT_EQ(status.where(), (root_ / "no/such/folder/f").string());
  // A folder of that name: the rename fails, and the temporary file goes.
  EXPECT_EQ(WriteFileAtomically(root_ / "beside", "x").code(), StatusCode::kIo);
  // One that fails leaves the others of its package as they were.
  const FileToWrite files[] = {{root_ / "f", "newer"}, {root_ / "beside", "x"}};
  EXPECT_EQ(WriteFilesAtomically(files).code(), StatusCode::kIo);
  EXPECT_EQ(*ReadFile(root_ / "f", 10), "new");
  int entries = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator(root_.path())) ++entries;
  EXPECT_EQ(entries, 4);  // three folders and f
}

}  // namespace
}  // namespace furrow::character

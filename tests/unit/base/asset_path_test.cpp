// SPDX-License-Identifier: Apache-2.0
#include "base/asset_path.h"

#include <cstdlib>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "tests/temporary_folder.h"

namespace furrow {
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

}  // namespace
}  // namespace furrow

// SPDX-License-Identifier: Apache-2.0
#include "server/machine/cache_folder.h"

#include <cstdlib>
#include <fstream>
#include <map>
#include <optional>
#include <string>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/temporary_folder.h"

namespace furrow::server {
namespace {

namespace fs = std::filesystem;

// Gives the environment variables back as they were.
class CacheFolderTest : public testing::Test {
 protected:
  ~CacheFolderTest() override {
    for (const auto& [name, value] : former_) {
      value ? setenv(name.c_str(), value->c_str(), 1) : unsetenv(name.c_str());
    }
  }
  // Null: unset.
  void Set(const std::string& name, const char* value) {
    const char* now = std::getenv(name.c_str());
    former_.try_emplace(name, now == nullptr ? std::nullopt : std::optional<std::string>(now));
    value == nullptr ? unsetenv(name.c_str()) : setenv(name.c_str(), value, 1);
  }
  TemporaryFolder folder_;

 private:
  std::map<std::string, std::optional<std::string>> former_;
};

TEST_F(CacheFolderTest, TheServiceManagersFolderComesFirst) {
  Set("CACHE_DIRECTORY", "/var/cache/furrow:/var/cache/other");
  Set("XDG_CACHE_HOME", "/x");
  Set("HOME", "/h");
  EXPECT_EQ(CacheFolder(), "/var/cache/furrow");
  Set("CACHE_DIRECTORY", nullptr);
  EXPECT_EQ(CacheFolder(), "/x/furrow");
  Set("XDG_CACHE_HOME", "relative");  // ignored, as its specification says
  EXPECT_EQ(CacheFolder(), "/h/.cache/furrow");
  Set("HOME", nullptr);
  EXPECT_EQ(CacheFolder(), "");
}

// As systemd makes it for a service with DynamicUser=.
TEST_F(CacheFolderTest, TheServiceManagersFolderMayBeALink) {
  const fs::path link = folder_ / "furrow";
  fs::create_directory(folder_ / "private");
  fs::create_directory_symlink("private", link);
  Set("CACHE_DIRECTORY", link.c_str());
  EXPECT_EQ(CacheFolder(), fs::canonical(folder_ / "private"));
  EXPECT_TRUE(PrepareCacheFolder(CacheFolder()).ok());
}

TEST_F(CacheFolderTest, TheFolderIsItsOwnersAlone) {
  const fs::path folder = folder_ / "a" / "furrow";
  ASSERT_TRUE(PrepareCacheFolder(folder).ok());
  struct stat found {};
  ASSERT_EQ(stat(folder.c_str(), &found), 0);
  EXPECT_EQ(found.st_mode & 0777, 0700u);
  EXPECT_TRUE(PrepareCacheFolder(folder).ok()) << "it exists";
}

TEST_F(CacheFolderTest, WhatOthersMayChangeIsNotUsed) {
  const fs::path open = folder_ / "open";
  fs::create_directory(open);
  chmod(open.c_str(), 0777);
  EXPECT_EQ(PrepareCacheFolder(open).code(), StatusCode::kInvalidArgument);
  // A link of somebody else could lead anywhere.
  const fs::path link = folder_ / "link";
  fs::create_directory_symlink(folder_.path(), link);
  EXPECT_EQ(PrepareCacheFolder(link).code(), StatusCode::kInvalidArgument);
  const fs::path file = folder_ / "file";
  std::ofstream(file) << "x";
  EXPECT_EQ(PrepareCacheFolder(file).code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(PrepareCacheFolder(file / "below").code(), StatusCode::kIo);
}

TEST_F(CacheFolderTest, DriversKeepShadersThereUnlessTheUserHasChosen) {
  Set("MESA_SHADER_CACHE_DIR", "/chosen");
  for (const char* name : {"MESA_SHADER_CACHE_MAX_SIZE", "__GL_SHADER_DISK_CACHE_PATH",
                           "__GL_SHADER_DISK_CACHE_SIZE"}) {
    Set(name, nullptr);
  }
  LetDriversCache(folder_.path());
  EXPECT_STREQ(std::getenv("MESA_SHADER_CACHE_DIR"), "/chosen");
  EXPECT_STREQ(std::getenv("MESA_SHADER_CACHE_MAX_SIZE"), "128M");
  EXPECT_EQ(std::getenv("__GL_SHADER_DISK_CACHE_PATH"), (folder_ / "nvidia").string());
  EXPECT_STREQ(std::getenv("__GL_SHADER_DISK_CACHE_SIZE"), "128000000");
  EXPECT_TRUE(fs::is_directory(folder_ / "nvidia"));
}

}  // namespace
}  // namespace furrow::server

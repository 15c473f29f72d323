// SPDX-License-Identifier: Apache-2.0
#include "server/daemon_files.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/temporary_folder.h"

namespace furrow::server {
namespace {

using testing::Contains;
using testing::Not;

// The kernel asks where a file is, not what it is called.
TEST(DaemonFiles, IncludeWhatALinkLeadsTo) {
  const TemporaryFolder folder;
  const std::filesystem::path root = std::filesystem::canonical(folder.path());
  for (const char* name : {"current", "releases", "other"}) {
    std::filesystem::create_directory(root / name);
  }
  for (const char* name : {"ada.glb", "ada.rig.json"}) std::ofstream(root / "releases" / name);
  std::filesystem::create_symlink(root / "releases" / "ada.glb", root / "current" / "ada.glb");
  Config config;
  config.character = root / "current" / "ada.glb";
  const Confinement files = FilesOf(config);
  EXPECT_THAT(files.read, Contains(root / "current"));
  EXPECT_THAT(files.read, Contains(root / "releases"));
  EXPECT_THAT(files.read, Not(Contains(root / "other")));
}

TEST(DaemonFiles, AShippedCharacterLiesInTheData) {
  const TemporaryFolder folder;
  const std::filesystem::path root = std::filesystem::canonical(folder.path());
  for (const char* name : {"share", "releases"}) std::filesystem::create_directory(root / name);
  std::ofstream(root / "releases" / "elder.glb");
  std::filesystem::create_symlink(root / "releases" / "elder.glb", root / "share" / "elder.glb");
  setenv("FURROW_DATA_DIR", (root / "share").c_str(), 1);
  Config config;
  config.character = "elder";
  const Confinement files = FilesOf(config);
  unsetenv("FURROW_DATA_DIR");
  EXPECT_THAT(files.read, Contains(root / "releases"));
}

}  // namespace
}  // namespace furrow::server

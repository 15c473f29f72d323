// SPDX-License-Identifier: Apache-2.0
#include "base/data_dir.h"

#include <cstdlib>
#include <fstream>

#include <gtest/gtest.h>

#include "tests/temporary_folder.h"

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

TEST(FileOrShipped, FilesAndSlashesComeFirstAndFoldersHideNothing) {
  const TemporaryFolder data;
  const TemporaryFolder here;
  const std::filesystem::path former = std::filesystem::current_path();
  setenv("FURROW_DATA_DIR", data.path().c_str(), 1);
  std::filesystem::current_path(here.path());
  std::filesystem::create_directory(data / "rigs");
  for (const char* name : {"rigs/face.json", "rigs/body.json"}) std::ofstream(data / name);
  std::ofstream(here / "body");
  std::filesystem::create_directory(here / "face");
  EXPECT_EQ(FileOrShipped("face", "rigs", ".json"), data / "rigs/face.json");
  EXPECT_EQ(FileOrShipped("face.json", "rigs", ".json"), data / "rigs/face.json");
  EXPECT_EQ(FileOrShipped("rigs/face.json", ".", ".json"), "rigs/face.json");
  EXPECT_EQ(FileOrShipped("body", "rigs", ".json"), "body");
  EXPECT_EQ(FileOrShipped("nobody", "rigs", ".json"), "nobody");
  std::filesystem::current_path(former);
  unsetenv("FURROW_DATA_DIR");
}

TEST(NotShipped, ListsWhatShipsAndWhatWasMeant) {
  const TemporaryFolder folder;
  for (const char* name : {"elder.glb", "elder.web.glb", "default.glb", "default.rig.json"}) {
    std::ofstream(folder / name);
  }
  setenv("FURROW_DATA_DIR", folder.path().c_str(), 1);
  const auto files = ListDataFiles(".", ".glb");
  ASSERT_TRUE(files.ok()) << files.status().ToString();
  ASSERT_EQ(files->size(), 3u);
  EXPECT_EQ(files->front().filename(), "default.glb");
  EXPECT_EQ(ListDataFiles("absent", ".glb").status().code(), StatusCode::kNotFound);
  EXPECT_EQ(NotShipped("character", ".", ".glb", "eldr").ToString(),
            "eldr: no such file, and no shipped character of this name (did you mean 'elder'? "
            "shipped characters: default, elder)");
  EXPECT_EQ(NotShipped("rig", "absent", ".json", "x").ToString(), "x: no such file");
  unsetenv("FURROW_DATA_DIR");
}

}  // namespace
}  // namespace furrow

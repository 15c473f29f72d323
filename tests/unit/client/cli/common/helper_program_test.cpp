// SPDX-License-Identifier: Apache-2.0
#include "client/cli/common/helper_program.h"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/temporary_folder.h"

namespace furrow::cli {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

std::string CommandOf(std::vector<const char*> argv) {
  const HelperCommand* command = FindHelperCommand(static_cast<int>(argv.size()), argv.data());
  return command == nullptr ? "" : command->name;
}

TEST(FindHelperCommand, FindsCommandsAndCommandsInGroups) {
  EXPECT_EQ(CommandOf({"furrow", "load", "--help"}), "load");
  EXPECT_EQ(CommandOf({"furrow", "character", "import", "x"}), "character");
  EXPECT_EQ(CommandOf({"furrow", "rig", "patch"}), "rig patch");
}

TEST(FindHelperCommand, LeavesOtherCommandsAlone) {
  EXPECT_EQ(CommandOf({"furrow"}), "");
  EXPECT_EQ(CommandOf({"furrow", "--help"}), "");
  EXPECT_EQ(CommandOf({"furrow", "play", "load"}), "");
  EXPECT_EQ(CommandOf({"furrow", "rig", "check", "patch"}), "");
}

TEST(AddHelperEntry, ListsTheCommandInHelp) {
  CLI::App app;
  AddHelperEntry(app, "load");
  AddHelperEntry(app, "rig patch");
  EXPECT_THAT(app.help(), HasSubstr(HelpOf("load")));
  EXPECT_THAT(app.help(), HasSubstr("  patch "));
}

class FindHelperProgramTest : public testing::Test {
 protected:
  void AddProgram(const fs::path& path) {
    fs::create_directories(path.parent_path());
    std::ofstream(path) << "#!/bin/sh\n";
    fs::permissions(path, fs::perms::owner_all);
  }

  TemporaryFolder folder_;
};

TEST_F(FindHelperProgramTest, LooksBesideTheProgramThenInLibexec) {
  const fs::path bin = folder_.path() / "bin";
  const fs::path libexec = folder_.path() / "libexec" / "furrow" / "furrow-load";
  AddProgram(libexec);
  const auto second = FindHelperProgram("furrow-load", bin);
  ASSERT_TRUE(second.ok()) << second.status().ToString();
  EXPECT_EQ(*second, libexec);
  AddProgram(bin / "furrow-load");
  const auto first = FindHelperProgram("furrow-load", bin);
  ASSERT_TRUE(first.ok()) << first.status().ToString();
  EXPECT_EQ(*first, bin / "furrow-load");
}

TEST_F(FindHelperProgramTest, AMissingProgramSaysWhatToBuild) {
  const auto missing = FindHelperProgram("furrow-load", folder_.path() / "bin");
  ASSERT_FALSE(missing.ok());
  EXPECT_EQ(missing.status().code(), StatusCode::kNotFound);
  EXPECT_THAT(missing.status().ToString(), HasSubstr("--target furrow-load"));
}

}  // namespace
}  // namespace furrow::cli

// SPDX-License-Identifier: Apache-2.0
#include "client/cli/common/helper_program.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace furrow::cli {
namespace {

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

}  // namespace
}  // namespace furrow::cli

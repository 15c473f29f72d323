// SPDX-License-Identifier: Apache-2.0
#include "client/cli/common/usage_error.h"

#include <gtest/gtest.h>

namespace furrow::cli {
namespace {

class UsageMessageTest : public testing::Test {
 protected:
  UsageMessageTest() {
    app_.require_subcommand(1);
    CLI::App* watch = app_.add_subcommand("watch", "");
    watch->add_option("HOST", host_)->required();
    watch->add_option("--format", format_);
    watch->add_option("--frames", frames_);
    CLI::App* rig = app_.add_subcommand("rig", "");
    rig->require_subcommand(1);
    rig->add_subcommand("check", "");
  }

  std::string MessageOf(const std::string& line) {
    try {
      app_.parse(line);
    } catch (const CLI::ParseError& error) {
      return UsageMessage(app_, error);
    }
    return "no error";
  }

 private:
  CLI::App app_{"", "furrow"};
  std::string host_;
  std::string format_;
  int frames_ = 0;
};

TEST_F(UsageMessageTest, NamesTheCommandThatWasMeant) {
  EXPECT_EQ(MessageOf("wathc localhost"),
            "unknown command 'wathc'; did you mean 'watch'? ('furrow --help' lists the commands)");
  EXPECT_EQ(MessageOf("rig chekc"),
            "unknown command 'chekc'; did you mean 'check'? ('furrow rig --help' lists the "
            "commands)");
  EXPECT_EQ(MessageOf("dance"), "unknown command 'dance' ('furrow --help' lists the commands)");
}

TEST_F(UsageMessageTest, NamesTheOptionThatWasMeant) {
  EXPECT_EQ(MessageOf("watch localhost --formta csv"),
            "unknown option '--formta'; did you mean '--format'? ('furrow watch --help' lists the "
            "options)");
  EXPECT_EQ(MessageOf("watch --frame=3"),
            "unknown option '--frame'; did you mean '--frames'? ('furrow watch --help' lists the "
            "options)")
      << "before the missing HOST";
  EXPECT_EQ(MessageOf("watch localhost -z"),
            "unknown option '-z' ('furrow watch --help' lists the options)");
}

TEST_F(UsageMessageTest, NamesWhatIsMissingOrTooMuch) {
  EXPECT_EQ(MessageOf(""), "a command is missing ('furrow --help' lists the commands)");
  EXPECT_EQ(MessageOf("rig"), "a command is missing ('furrow rig --help' lists the commands)");
  EXPECT_EQ(MessageOf("watch a b"),
            "unexpected argument 'b' ('furrow watch --help' shows the usage)");
  EXPECT_EQ(MessageOf("watch"), "HOST is required ('furrow watch --help' explains the options)");
}

}  // namespace
}  // namespace furrow::cli

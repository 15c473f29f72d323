// SPDX-License-Identifier: Apache-2.0
#include "base/text.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace furrow {
namespace {

TEST(ShellWord, QuotesWhatAShellWouldSplit) {
  EXPECT_EQ(ShellWord("/etc/furrow/furrow.toml"), "/etc/furrow/furrow.toml");
  EXPECT_EQ(ShellWord("/my show/a.toml"), "'/my show/a.toml'");
  EXPECT_EQ(ShellWord("$it's"), "'$it'\\''s'");
  EXPECT_EQ(ShellWord(""), "''");
}

TEST(Quoted, ShowsPrintableAsciiOnly) {
  EXPECT_EQ(Quoted("jaw"), "'jaw'");
  EXPECT_EQ(Quoted(""), "''");
  EXPECT_EQ(Quoted(std::string("a\x1b[31m\n\xc3\xa4\0b", 11)), "'a?[31m????b'");
}

TEST(Quoted, CutsAfterFortyBytes) {
  EXPECT_EQ(Quoted(std::string(40, 'x')), "'" + std::string(40, 'x') + "'");
  EXPECT_EQ(Quoted(std::string(41, 'x')), "'" + std::string(40, 'x') + "...'");
}

TEST(Counted, OnlyOneIsSingular) {
  EXPECT_EQ(Counted(0, "pose"), "0 poses");
  EXPECT_EQ(Counted(1, "pose"), "1 pose");
  EXPECT_EQ(Counted(21, "pose"), "21 poses");
  EXPECT_EQ(Counted(1, "search", "searches"), "1 search");
  EXPECT_EQ(Counted(2, "search", "searches"), "2 searches");
}

TEST(ClosestWord, FindsTypingMistakes) {
  const std::vector<std::string> known = {"play", "watch", "frames", "record", "rig"};
  EXPECT_EQ(ClosestWord("plya", known), "play");   // exchanged
  EXPECT_EQ(ClosestWord("wach", known), "watch");  // left out
  EXPECT_EQ(ClosestWord("Frame", known), "frames");
  EXPECT_EQ(ClosestWord("recodr", known), "record");
  EXPECT_EQ(ClosestWord("rec", known), "record");  // begins so
  EXPECT_EQ(ClosestWord("rug", known), "rig");
}

const std::vector<std::string> kKnown = {"--tcp", "--udp"};

TEST(DidYouMean, AsksForTheClosestWord) {
  EXPECT_EQ(DidYouMean("--tpc", kKnown), "did you mean '--tcp'?");
  EXPECT_EQ(DidYouMean("bnid", std::vector<std::string>{"bind"}, "listen."),
            "did you mean 'listen.bind'?");
  EXPECT_EQ(DidYouMean("--colour", kKnown), "");
}

TEST(UnknownWord, NamesTheWordAndWhereToLook) {
  EXPECT_EQ(UnknownWord("option", "--tpc", kKnown, "furrowd"),
            "unknown option '--tpc'; did you mean '--tcp'? ('furrowd --help' lists the options)");
  EXPECT_EQ(UnknownWord("command", "sing", {}, "furrow rig"),
            "unknown command 'sing' ('furrow rig --help' lists the commands)");
}

TEST(ClosestWord, LeavesOutWhatIsNotClose) {
  const std::vector<std::string> known = {"play", "--tcp", std::string(80, 'a')};
  EXPECT_EQ(ClosestWord("solve", known), "");
  EXPECT_EQ(ClosestWord("", known), "");
  EXPECT_EQ(ClosestWord("xx", known), "");
  EXPECT_EQ(ClosestWord(std::string(80, 'a'), known), "");
  EXPECT_EQ(ClosestWord("play", {}), "");
  EXPECT_EQ(ClosestWord("--tpc", known), "--tcp");
}

TEST(LineOf, CountsFromOne) {
  constexpr std::string_view kText = "a\nbc\n\nd";
  EXPECT_EQ(LineOf(kText, 0), 1u);
  EXPECT_EQ(LineOf(kText, 1), 1u);  // the line end belongs to its line
  EXPECT_EQ(LineOf(kText, 2), 2u);
  EXPECT_EQ(LineOf(kText, 6), 4u);
  EXPECT_EQ(LineOf(kText, 999), 4u);
  EXPECT_EQ(Where("a.obj", LineOf(kText, 2)), "a.obj:2");
}

TEST(SplitWords, SplitsAtBlanksAndDropsComments) {
  std::vector<std::string_view> words = {"stale"};
  SplitWords("  v 1.0\t-2 # v 3", &words);
  EXPECT_THAT(words, ::testing::ElementsAre("v", "1.0", "-2"));
  SplitWords("# nothing", &words);
  EXPECT_THAT(words, ::testing::IsEmpty());
  SplitWords("", &words);
  EXPECT_THAT(words, ::testing::IsEmpty());
}

TEST(TakeToken, RemovesTheTokenFromTheLine) {
  std::string_view line = "  one two";
  EXPECT_EQ(TakeToken(&line), "one");
  EXPECT_EQ(TakeToken(&line), "two");
  EXPECT_EQ(TakeToken(&line), "");
  EXPECT_EQ(line, "");
}

TEST(AsText, SeesTheSameBytes) {
  const std::vector<std::uint8_t> bytes = {'o', 'k', 0};
  EXPECT_EQ(AsText(bytes), std::string_view("ok\0", 3));
}

// RFC 3986, section 2.1.
TEST(DecodePercent, ReplacesEscapesOfEitherCase) {
  EXPECT_EQ(DecodePercent("brow_%2A%2c%C3%a9+%25"), "brow_*,\u00e9+%");
  EXPECT_EQ(DecodePercent(""), "");
  EXPECT_EQ(DecodePercent("%00")->size(), 1u);
}

TEST(DecodePercent, RefusesWhatIsCutOrNotHexadecimal) {
  for (const char* const text : {"%", "%2", "a%", "%2g", "%g2", "%-1", "% 1", "%%41"}) {
    EXPECT_FALSE(DecodePercent(text)) << text;
  }
}

}  // namespace
}  // namespace furrow

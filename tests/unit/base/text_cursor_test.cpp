// SPDX-License-Identifier: Apache-2.0
#include "base/text_cursor.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace furrow {
namespace {

std::vector<std::string> Tokens(std::string_view text) {
  TextCursor cursor(text, "f");
  std::vector<std::string> tokens;
  while (true) {
    const std::string_view token = cursor.NextToken();
    if (token.empty()) return tokens;
    EXPECT_EQ(std::string(token), tokens.emplace_back(token));
  }
}

TEST(TextCursor, BracesAreTokens) {
  EXPECT_THAT(Tokens("ROOT hip{OFFSET 0\t1 }"),
              ::testing::ElementsAre("ROOT", "hip", "{", "OFFSET", "0", "1", "}"));
  EXPECT_THAT(Tokens("\xEF\xBB\xBF a\r\n\r b"), ::testing::ElementsAre("a", "b"));
  EXPECT_THAT(Tokens(" \n\t "), ::testing::IsEmpty());
}

TEST(TextCursor, PeekLeavesTheCursor) {
  TextCursor cursor("a\nb", "f");
  EXPECT_EQ(cursor.PeekToken(), "a");
  EXPECT_EQ(cursor.NextToken(), "a");
  EXPECT_EQ(cursor.PeekToken(), "b");
  EXPECT_EQ(cursor.line(), 1u);
  EXPECT_EQ(cursor.NextToken(), "b");
  EXPECT_EQ(cursor.Where(), "f:2");
}

TEST(TextCursor, RestOfLineStopsBeforeABrace) {
  TextCursor cursor("JOINT left arm \t{\n", "f");
  EXPECT_EQ(cursor.NextToken(), "JOINT");
  EXPECT_EQ(cursor.RestOfLine(), "left arm");
  EXPECT_EQ(cursor.NextToken(), "{");
}

// Every kind of line end, blank lines in between, and a last line without an end.
TEST(TextCursor, NextLineCountsEveryKindOfLineEnd) {
  TextCursor cursor("one\r\n\n  \rtwo\nthree", "take.csv");
  std::string_view line;
  ASSERT_TRUE(cursor.NextLine(&line));
  EXPECT_EQ(line, "one");
  EXPECT_EQ(cursor.line(), 1u);
  ASSERT_TRUE(cursor.NextLine(&line));
  EXPECT_EQ(line, "two");
  EXPECT_EQ(cursor.line(), 4u);
  EXPECT_TRUE(cursor.line_was_ended());
  ASSERT_TRUE(cursor.NextLine(&line));
  EXPECT_EQ(line, "three");
  EXPECT_FALSE(cursor.line_was_ended());
  EXPECT_EQ(cursor.Error(StatusCode::kParse, "bad").ToString(), "take.csv:5: bad");
  EXPECT_FALSE(cursor.NextLine(&line));
}

}  // namespace
}  // namespace furrow

// SPDX-License-Identifier: Apache-2.0
#include "protocol/messages/error_text.h"

#include <gtest/gtest.h>

#include <set>

namespace furrow::protocol {
namespace {

TEST(ErrorText, AnErrorWithoutATextGetsTheSentenceOfItsCode) {
  std::set<std::string> sentences;
  for (int code = 1; code <= static_cast<int>(ErrorCode::kNotPermitted); ++code) {
    const std::string sentence = SentenceOf({static_cast<ErrorCode>(code), ""});
    EXPECT_FALSE(sentence.empty());
    EXPECT_TRUE(sentences.insert(sentence).second) << sentence;
  }
  EXPECT_EQ(SentenceOf({ErrorCode::kNeedsToken, ""}), "the daemon requires a token");
}

TEST(ErrorText, TheTextOfTheSenderComesFirst) {
  EXPECT_EQ(SentenceOf({ErrorCode::kNeedsToken, "show one"}), "show one");
}

}  // namespace
}  // namespace furrow::protocol

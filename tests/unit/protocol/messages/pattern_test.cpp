// SPDX-License-Identifier: Apache-2.0
#include "protocol/messages/pattern.h"

#include <string>

#include <gtest/gtest.h>

namespace furrow::protocol {
namespace {

TEST(Pattern, Globs) {
  EXPECT_TRUE(MatchesPattern("*", "brow_l.squash"));
  EXPECT_TRUE(MatchesPattern("brow_?.*", "brow_l.squash"));
  EXPECT_TRUE(MatchesPattern("*.squash", "brow_l.squash"));
  EXPECT_TRUE(MatchesPattern("b*w*sh", "brow_l.squash"));
  EXPECT_TRUE(MatchesPattern("brow_l.squash", "brow_l.squash"));
  EXPECT_TRUE(MatchesPattern("a*b*c", "aXbYbZc"));
  EXPECT_FALSE(MatchesPattern("brow_?", "brow_l.squash"));
  EXPECT_FALSE(MatchesPattern("brow", "brow_l"));
  EXPECT_FALSE(MatchesPattern("Brow_*", "brow_l"));
  EXPECT_FALSE(MatchesPattern("?", ""));
  EXPECT_TRUE(MatchesPattern("**", ""));
}

TEST(Pattern, CommaLists) {
  EXPECT_TRUE(MatchesPattern("nose.*, knee_l*", "knee_l_inner.folds"));
  EXPECT_TRUE(MatchesPattern(" nose.* ,x", "nose.squash"));
  EXPECT_FALSE(MatchesPattern("", "a"));
  EXPECT_FALSE(MatchesPattern(",,", "a"));
  EXPECT_FALSE(MatchesPattern(",", ""));
}

TEST(Pattern, ManyStarsTakeProductTime) {
  std::string pattern;
  for (int i = 0; i < 1000; ++i) pattern += "a*";
  const std::string name(255, 'a');
  EXPECT_FALSE(MatchesPattern(pattern + "b", name));
}

}  // namespace
}  // namespace furrow::protocol

// SPDX-License-Identifier: Apache-2.0
#include "base/joined.h"

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace furrow {
namespace {

TEST(Joined, ListsTextsOfAnyRange) {
  EXPECT_EQ(Joined(std::vector<std::string>{}), "");
  EXPECT_EQ(Joined(std::vector<std::string>{"a"}), "a");
  EXPECT_EQ(Joined(std::array<std::string_view, 3>{"a", "b", "c"}), "a, b, c");
  EXPECT_EQ(Joined(std::views::keys(std::map<std::string, int>{{"x", 1}, {"y", 2}})), "x, y");
}

TEST(Joined, TakesTheTextFromAMemberOrAFunction) {
  struct Named {
    std::string name;
    int number = 0;
  };
  const std::vector<Named> items = {{"one", 1}, {"two", 2}};
  EXPECT_EQ(Joined(items, &Named::name), "one, two");
  EXPECT_EQ(Joined(items, [](const Named& item) { return std::to_string(item.number); }), "1, 2");
}

}  // namespace
}  // namespace furrow

// SPDX-License-Identifier: Apache-2.0
#include "client/cli/common/endpoint.h"

#include <gtest/gtest.h>

#include "client/cli/common/command.h"

namespace furrow::cli {
namespace {

TEST(ParseHostTest, RejectsWhatACommandCannotUse) {
  const HostKeys all{.several_subjects = true, .pattern = true, .rate = true, .udp = true};
  const char* const several = "furrow://a?subject=b&subject=c";
  for (const char* text :
       {several, "furrow://a?pattern=*", "furrow://a?rate=5", "furrow://a?transport=udp"}) {
    EXPECT_TRUE(ParseHost(text, all).has_value()) << text;
    EXPECT_FALSE(ParseHost(text, {}).has_value()) << text;
  }
  for (const char* text : {"a", "furrow://a?subject=b", "furrow://a?transport=tcp"}) {
    EXPECT_TRUE(ParseHost(text, {}).has_value()) << text;
  }
  EXPECT_FALSE(ParseHost("http://a", all).has_value());
}

TEST(ParseSizeTest, AcceptsOnlySizesInTheRange) {
  int width = 0;
  int height = 0;
  EXPECT_TRUE(ParseSize("640x480", &width, &height));
  EXPECT_EQ(width, 640);
  EXPECT_EQ(height, 480);
  for (const char* text :
       {"", "640", "640x", "x480", "15x480", "640x4097", "640x480x", "-16x20", "1e2x99"}) {
    EXPECT_FALSE(ParseSize(text, &width, &height)) << text;
  }
}

}  // namespace
}  // namespace furrow::cli

// SPDX-License-Identifier: Apache-2.0
#include "client/cli/common/command.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace furrow::cli {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

TEST(Within, AcceptsOnlyNumbersInTheRange) {
  const CLI::Validator range = Within(-0.5, 1e6);
  for (const char* inside : {"-0.5", "0", "1e6", "12.75"}) {
    EXPECT_THAT(range(inside), IsEmpty()) << inside;
  }
  for (const char* outside :
       {"-0.51", "1000001", "nan", "-nan", "NAN", "inf", "-inf", "1e999", "twelve", "", "1 2"}) {
    EXPECT_THAT(range(outside), HasSubstr("1e+06")) << outside;
  }
}

TEST(AddBvhOptions, ReadsHowBvhFilesAreMeant) {
  CLI::App app;
  motion::LoadOptions options;
  AddBvhOptions(app, options);
  app.parse("--bvh-positions offsets --up-axis z");
  EXPECT_EQ(options.bvh_positions, motion::BvhPositions::kOffsets);
  EXPECT_EQ(options.up_axis, motion::UpAxis::kZ);
  EXPECT_THROW(app.parse("--bvh-positions some"), CLI::ParseError);
  EXPECT_THROW(app.parse("--rest-frame 3"), CLI::ParseError) << "not for poses of a rig";
}

}  // namespace
}  // namespace furrow::cli

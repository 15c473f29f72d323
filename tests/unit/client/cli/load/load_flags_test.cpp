// SPDX-License-Identifier: Apache-2.0
#include "client/cli/load/load_flags.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace furrow::cli {
namespace {

using testing::HasSubstr;

std::string WrongUsageOf(const std::string& options) {
  CLI::App app;
  LoadFlags flags;
  AddLoadFlags(app, flags);
  app.parse("localhost performance.bvh " + options);
  return WrongUsage(flags);
}

TEST(LoadFlags, WhatDatagramsAloneKnowIsWrongOverTcpAlone) {
  for (const char* fault :
       {"--loss", "--reorder", "--duplicate", "--delay", "--falsify", "--swap"}) {
    const std::string asked = std::string(fault) + " 0.2";
    EXPECT_THAT(WrongUsageOf("--tcp " + asked), HasSubstr(fault + std::string(": this befalls")));
    EXPECT_EQ(WrongUsageOf("--both " + asked), "");
    EXPECT_EQ(WrongUsageOf("--udp " + asked), "");
  }
  EXPECT_THAT(WrongUsageOf("--tcp --loss 0.1 --falsify 0.1"), HasSubstr("--loss, --falsify: "));
  EXPECT_EQ(WrongUsageOf("--tcp --jitter 3 --black-hole 1:1"), "");
}

TEST(LoadFlags, ComparisonsAreMadeInPeace) {
  EXPECT_THAT(WrongUsageOf("--find-max --loss 0.1"), HasSubstr("in peace"));
  EXPECT_THAT(WrongUsageOf("--baseline --jitter 3"), HasSubstr("in peace"));
  EXPECT_EQ(WrongUsageOf("--find-max --baseline"), "");
}

TEST(LoadFlags, AProcessThatIsNotThereIsWrong) {
  EXPECT_EQ(WrongUsageOf("--pid " + std::to_string(getpid())), "");
  EXPECT_THAT(WrongUsageOf("--pid 2147483647"), HasSubstr("no such process"));
}

}  // namespace
}  // namespace furrow::cli

// SPDX-License-Identifier: Apache-2.0
#include "client/cli/load/load_flags.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace furrow::cli {
namespace {

using testing::HasSubstr;

std::string ConflictOf(const std::string& options) {
  CLI::App app;
  LoadFlags flags;
  AddLoadFlags(app, flags);
  app.parse("localhost performance.bvh " + options);
  return FindConflict(flags);
}

TEST(LoadFlags, DatagramFaultsConflictWithTcpOnly) {
  for (const char* fault :
       {"--loss", "--reorder", "--duplicate", "--delay", "--falsify", "--swap"}) {
    const std::string asked = std::string(fault) + " 0.2";
    EXPECT_THAT(ConflictOf("--tcp " + asked),
                HasSubstr(fault + std::string(": applies to datagrams only")));
    EXPECT_EQ(ConflictOf("--both " + asked), "");
    EXPECT_EQ(ConflictOf("--udp " + asked), "");
  }
  EXPECT_THAT(ConflictOf("--tcp --loss 0.1 --falsify 0.1"), HasSubstr("--loss, --falsify: "));
  EXPECT_EQ(ConflictOf("--tcp --jitter 3 --black-hole 1:1"), "");
}

TEST(LoadFlags, ComparisonsConflictWithFaults) {
  EXPECT_THAT(ConflictOf("--find-max --loss 0.1"), HasSubstr("without injected faults"));
  EXPECT_THAT(ConflictOf("--baseline --jitter 3"), HasSubstr("without injected faults"));
  EXPECT_EQ(ConflictOf("--find-max --baseline"), "");
}

TEST(LoadFlags, AMissingProcessIsAnError) {
  EXPECT_EQ(ConflictOf("--pid " + std::to_string(getpid())), "");
  EXPECT_THAT(ConflictOf("--pid 2147483647"), HasSubstr("no such process"));
}

}  // namespace
}  // namespace furrow::cli

// SPDX-License-Identifier: Apache-2.0
#include "client/load/run/run.h"

#include <gtest/gtest.h>

#include "client/load/compare/echo_server.h"
#include "protocol/codec/codec.h"
#include "tests/unit/client/load/workload_testing.h"

namespace furrow::load {
namespace {

RunHooks Quiet(std::function<bool()> keep_going) {
  return {.keep_going = std::move(keep_going),
          .solving = [](double) {},
          .resolving = [](double) {},
          .second = [](double, const Tally&, const Histogram&) {}};
}

// Runs against a raw echo.
class RunTest : public testing::Test {
 protected:
  void SetUp() override {
    protocol::PoseFrame pose{.skeleton_hash = 1, .num_blend_shapes = 3};
    pose.blend_shape_indices = {0, 1, 2};
    pose.blend_shapes = {0.1f, 0.2f, 0.3f};
    for (std::size_t i = 0; i < workload_.times.size(); ++i)
      protocol::Encoder().Encode({.session = 1}, pose, workload_.messages.emplace_back());
    options_.plan = {.subjects = 4, .phases = 4, .rate = 100.0, .seconds = 0.1};
    options_.check_weights = false;
  }
  RunResult Run(const std::function<bool()>& keep_going) {
    auto echo = EchoServer::Start(std::nullopt);
    EXPECT_TRUE(echo.ok()) << echo.status().ToString();
    const Target target{
        .host = "127.0.0.1", .udp = echo->port(), .tcp = 0, .echo = true, .pid = {}};
    auto result = load::Run(workload_, target, options_, Quiet(keep_going));
    EXPECT_TRUE(result.ok()) << result.status().ToString();
    return *std::move(result);
  }

  Workload workload_ = MakePerformance();
  RunOptions options_;
};

// A pose that is sent early would return before its scheduled time.
TEST_F(RunTest, NoPoseIsSentBeforeItIsDue) {
  const RunResult result = Run([] { return true; });
  EXPECT_EQ(result.tally.sent, 40u);
  ASSERT_GT(result.tally.received, 0u);
  EXPECT_EQ(result.tally.early, 0u);
  EXPECT_GT(result.latency_ns.min(), 0);
}

TEST_F(RunTest, AnInterruptBeforeTheFirstPoseGivesARunOfZeroSeconds) {
  const RunResult result = Run([] { return false; });
  EXPECT_TRUE(result.interrupted);
  EXPECT_EQ(result.tally.offered, 0u);
  EXPECT_EQ(result.seconds, 0.0);
}

}  // namespace
}  // namespace furrow::load

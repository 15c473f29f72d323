// SPDX-License-Identifier: Apache-2.0
#include "client/load/run.h"

#include <gtest/gtest.h>

#include "client/load/net/echo.h"
#include "performance_testing.h"
#include "protocol/codec/codec.h"

namespace furrow::load {
namespace {

RunHooks Quiet(std::function<bool()> go_on) {
  return {.go_on = std::move(go_on),
          .solving = [](double) {},
          .settling = [](double) {},
          .second = [](double, const Tally&, const Histogram&) {}};
}

// Against a raw echo, with poses in it.
class RunTest : public testing::Test {
 protected:
  void SetUp() override {
    protocol::PoseFrame pose{.skeleton_hash = 1, .num_blend_shapes = 3};
    pose.blend_shape_indices = {0, 1, 2};
    pose.blend_shapes = {0.1f, 0.2f, 0.3f};
    for (std::size_t i = 0; i < performance_.times.size(); ++i)
      protocol::Encoder().Encode({.session = 1}, pose, performance_.messages.emplace_back());
    options_.plan = {.subjects = 4, .phases = 4, .rate = 100.0, .seconds = 0.1};
    options_.check_weights = false;
  }
  RunResult Run(const std::function<bool()>& go_on) {
    auto echo = EchoServer::Start(std::nullopt);
    EXPECT_TRUE(echo.ok()) << echo.status().ToString();
    const Target target{
        .host = "127.0.0.1", .udp = echo->port(), .tcp = 0, .echo = true, .pid = {}};
    auto result = load::Run(performance_, target, options_, Quiet(go_on));
    EXPECT_TRUE(result.ok()) << result.status().ToString();
    return *std::move(result);
  }

  Performance performance_ = MakePerformance();
  RunOptions options_;
};

// One that leaves early would come back before it is due.
TEST_F(RunTest, NoPoseLeavesBeforeItIsDue) {
  const RunResult result = Run([] { return true; });
  EXPECT_EQ(result.tally.sent, 40u);
  ASSERT_GT(result.tally.received, 0u);
  EXPECT_EQ(result.tally.early, 0u);
  EXPECT_GT(result.latency_ns.min(), 0);
}

TEST_F(RunTest, AnInterruptBeforeTheFirstPoseLeavesARunOfNoTime) {
  const RunResult result = Run([] { return false; });
  EXPECT_TRUE(result.interrupted);
  EXPECT_EQ(result.tally.offered, 0u);
  EXPECT_EQ(result.seconds, 0.0);
}

}  // namespace
}  // namespace furrow::load

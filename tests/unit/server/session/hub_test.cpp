// SPDX-License-Identifier: Apache-2.0
#include "server/session/hub.h"

#include <gtest/gtest.h>

#include "tests/unit/server/session/hub_fixture.h"

namespace furrow::server {
namespace {

using protocol::ErrorCode;

class HubSessionTest : public HubPeersTest {};

TEST_F(HubSessionTest, PeersThatNeitherSendNorSubscribeAreIdle) {
  Limits limits;
  limits.idle_seconds = 30;
  Make(limits);
  Connect(&sender);
  Connect(&viewer);
  Watch(viewer, {.subject = "ann", .wait = true});
  Advance(29);
  EXPECT_FALSE(hub->IsIdle(sender.id, now));
  Advance(2);
  EXPECT_TRUE(hub->IsIdle(sender.id, now));
  EXPECT_FALSE(hub->IsIdle(viewer.id, now)) << "it waits for its subject";
  Send(sender, protocol::Ping{});
  EXPECT_FALSE(hub->IsIdle(sender.id, now));
}

TEST_F(HubSessionTest, GarbageIsAnsweredOnTcpAndIgnoredOnUdp) {
  FakePeer udp;
  Connect(&udp, Transport::kUdp);
  std::vector<std::uint8_t> good;
  encoder.Encode({1, 0, 0, 0}, protocol::Ping{}, good);
  for (std::size_t size = 0; size < good.size(); ++size) {
    const std::vector<std::uint8_t> bytes(good.begin(), good.begin() + static_cast<long>(size));
    hub->OnMessage(udp.id, bytes, now);
    hub->OnMessage(viewer.id, bytes, now);
    ExpectError(viewer, ErrorCode::kMalformed);
  }
  EXPECT_TRUE(udp.inbox.empty());
  std::vector<std::uint8_t> newer = good;
  newer[4] = 2;
  hub->OnMessage(viewer.id, newer, now);
  ExpectError(viewer, ErrorCode::kUnsupportedVersion);
  Send(viewer, protocol::Welcome{"not a server", 0});
  ExpectError(viewer, ErrorCode::kUnsupported);
  hub->OnBadFrame(viewer.id);
  ExpectError(viewer, ErrorCode::kMalformed);
}

TEST_F(HubSessionTest, DrainingSaysGoodbyeAndRefusesSubscriptions) {
  hub->Drain(Time{0});
  EXPECT_EQ(viewer.Take<protocol::Goodbye>()->message.reason, protocol::GoodbyeReason::kDraining);
  Send(viewer, protocol::SubscribeWeights{.wait = true});
  ExpectError(viewer, ErrorCode::kDraining);
}

TEST_F(HubSessionTest, NothingFollowsAGoodbye) {
  Publish(sender, "ann");
  EXPECT_NE(Watch(viewer, {.subject = "ann", .max_rate_hz = 10.0}), 0);
  Send(sender, Pose(0.5f), 1, 0);
  ASSERT_TRUE(viewer.Take<protocol::WeightFrame>().has_value());
  Send(sender, Pose(0.25f), 1, 1);  // owed
  hub->Drain(Time{0});
  EXPECT_TRUE(viewer.Take<protocol::Goodbye>().has_value());
  Advance(1.0);
  hub->Tick(now);
  Send(sender, Pose(0.75f), 1, 2);
  EXPECT_TRUE(viewer.inbox.empty());
}

}  // namespace
}  // namespace furrow::server

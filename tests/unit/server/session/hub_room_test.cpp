// SPDX-License-Identifier: Apache-2.0
// Which connections give way to newcomers.
#include <string>

#include <gtest/gtest.h>

#include "tests/unit/server/session/hub_fixture.h"

namespace furrow::server {
namespace {

using protocol::ErrorCode;

class HubRoom : public HubTest {
 protected:
  void ConnectFrom(FakePeer* peer, const std::string& host) {
    peer->id = hub->AddPeer(Transport::kTcp, {"fake", host}, peer, now);
  }
  void WaitForNobody(FakePeer& peer) {
    ASSERT_NE(Watch(peer, {.subject = "nobody", .wait = true}), 0);
  }
  bool MakeRoom(const std::string& host, bool any_host = false) {
    return hub->MakeRoom(Transport::kTcp, host, any_host, now);
  }
  // True if the peer was told why it must leave.
  static void ExpectGone(FakePeer& peer) {
    const auto error = peer.Take<protocol::ErrorMessage>();
    ASSERT_TRUE(error.has_value());
    EXPECT_EQ(error->message.code, ErrorCode::kLimit);
    EXPECT_NE(error->message.message.find("newcomer"), std::string::npos);
    EXPECT_TRUE(peer.finished);
  }
};

TEST_F(HubRoom, TheConnectionThatHasWaitedLongestGivesWay) {
  FakePeer first, second;
  ConnectFrom(&first, "a");
  Advance(1);
  ConnectFrom(&second, "a");
  WaitForNobody(second);
  WaitForNobody(first);
  ASSERT_TRUE(MakeRoom("a"));
  ExpectGone(first);
  EXPECT_FALSE(second.finished);
  EXPECT_EQ(hub->num_subscriptions(), 1u);
  EXPECT_EQ(Count(Counter::kConnectionsGaveWay), 1u);
  // Once: the first is leaving already.
  ASSERT_TRUE(MakeRoom("a"));
  ExpectGone(second);
  EXPECT_FALSE(MakeRoom("a"));
  EXPECT_TRUE(hub->IsIdle(first.id, now)) << "its connection may close";
}

TEST_F(HubRoom, WhoHasShownNoTokenGivesWayFirst) {
  FakePeer viewer, stranger;
  ConnectFrom(&viewer, "a");
  WaitForNobody(viewer);
  Advance(1);
  stranger.id = hub->AddPeer(Transport::kTcp, {"fake", "a"}, &stranger, now, 0, Access());
  now += Hub::kUnusedPatience;
  ASSERT_TRUE(MakeRoom("a"));
  ExpectGone(stranger);
  EXPECT_FALSE(viewer.finished) << "although it has waited for longer";
}

TEST_F(HubRoom, ConnectionsInUseStay) {
  FakePeer sender, viewer;
  ConnectFrom(&sender, "a");
  ConnectFrom(&viewer, "a");
  Publish(sender, "ann");
  ASSERT_NE(Watch(viewer, {.subject = "ann", .wait = true}), 0);
  for (int second = 0; second < 10; ++second) {
    Advance(1);
    Send(sender, Pose(0.5f), 1, static_cast<std::uint32_t>(second));
    hub->Tick(now);
    ASSERT_FALSE(MakeRoom("a", true)) << second;
  }
}

TEST_F(HubRoom, AViewerWaitsFromTheMomentWhenItsSubjectHasLeft) {
  FakePeer sender, viewer, later;
  ConnectFrom(&sender, "b");
  ConnectFrom(&viewer, "a");
  Publish(sender, "ann");
  ASSERT_NE(Watch(viewer, {.subject = "ann", .wait = true}), 0);
  Advance(1);
  ConnectFrom(&later, "a");
  WaitForNobody(later);
  Advance(1);
  Send(sender, Pose(0.5f), 1, 0);
  hub->Tick(now);
  // The subject leaves, after the other viewer has begun to wait.
  Send(sender, protocol::Goodbye{}, 1);
  for (int i = 0; i < 100 && hub->num_subjects() > 0; ++i) {
    Advance(1);
    hub->Tick(now);
  }
  ASSERT_EQ(hub->num_subjects(), 0u);
  ASSERT_TRUE(MakeRoom("a"));
  ExpectGone(later);
  EXPECT_FALSE(viewer.finished);
}

TEST_F(HubRoom, NewConnectionsHaveTimeToSayWhatTheyWant) {
  FakePeer silent;
  ConnectFrom(&silent, "a");
  EXPECT_FALSE(MakeRoom("a"));
  Advance(ToSeconds(Hub::kUnusedPatience));
  Send(silent, protocol::Ping{});
  (void)silent.Take<protocol::Pong>();
  ASSERT_TRUE(MakeRoom("a")) << "pings do not use the place";
  ExpectGone(silent);
}

TEST_F(HubRoom, OtherHostsGiveWayOnlyToAHostWithoutAPlace) {
  FakePeer waiting;
  ConnectFrom(&waiting, "a");
  WaitForNobody(waiting);
  EXPECT_FALSE(MakeRoom("b"));
  EXPECT_TRUE(MakeRoom("b", /*any_host=*/true));
  ExpectGone(waiting);
}

TEST_F(HubRoom, WebConnectionsCloseByAGoodbye) {
  FakePeer web;
  web.id = hub->AddPeer(Transport::kWeb, {"web", "a"}, &web, now);
  WaitForNobody(web);
  EXPECT_FALSE(MakeRoom("a")) << "TCP has places of its own";
  ASSERT_TRUE(hub->MakeRoom(Transport::kWeb, "a", false, now));
  ExpectGone(web);
  const auto goodbye = web.Take<protocol::Goodbye>();
  ASSERT_TRUE(goodbye.has_value());
  EXPECT_EQ(goodbye->header.stream, 0);
}

}  // namespace
}  // namespace furrow::server

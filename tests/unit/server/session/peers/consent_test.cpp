// SPDX-License-Identifier: Apache-2.0
#include "server/session/peers/consent.h"

#include <gtest/gtest.h>

#include "protocol/messages/limits.h"
#include "tests/unit/server/session/hub_fixture.h"

namespace furrow::server {
namespace {

constexpr Time kConsentStart = FromSeconds(100);

TEST(Consent, HoldsForTwoSecondsAfterTheChallengeThatWasAnswered) {
  Consent consent;
  consent.Begin(kConsentStart);
  EXPECT_TRUE(consent.Holds(kConsentStart + Consent::kPause));
  EXPECT_FALSE(consent.Holds(kConsentStart + Consent::kPause + FromSeconds(0.001)));
  consent.Sent(5, kConsentStart + FromSeconds(1));
  // A late answer does not prolong it further than a quick one.
  consent.Answered(5);
  EXPECT_TRUE(consent.Holds(kConsentStart + FromSeconds(3)));
  EXPECT_FALSE(consent.Holds(kConsentStart + FromSeconds(3.001)));
}

TEST(Consent, DoesNotRunOutWhileTheDaemonStandsStill) {
  Consent consent;
  consent.Begin(kConsentStart);
  consent.Sent(5, kConsentStart + FromSeconds(1));
  consent.OnStall(FromSeconds(60));
  EXPECT_TRUE(consent.Holds(kConsentStart + FromSeconds(62)));
  EXPECT_FALSE(consent.Holds(kConsentStart + FromSeconds(62.001)));
  consent.Answered(5);
  EXPECT_TRUE(consent.Holds(kConsentStart + FromSeconds(63)));
  EXPECT_FALSE(consent.Holds(kConsentStart + FromSeconds(63.001)));
}

TEST(Consent, IsRenewedOnlyByTheNumberOfAChallenge) {
  Consent consent;
  consent.Begin(kConsentStart);
  consent.Answered(0);  // nothing was asked yet
  consent.Sent(7, kConsentStart + FromSeconds(1));
  consent.Answered(8);
  EXPECT_EQ(consent.answered(), kConsentStart);
  consent.Answered(7);
  EXPECT_EQ(consent.answered(), kConsentStart + FromSeconds(1));
}

TEST(Consent, AnswersMayComeLateAndOutOfOrder) {
  Consent consent;
  consent.Begin(kConsentStart);
  for (int i = 1; i <= 5; ++i) consent.Sent(i, kConsentStart + i * Consent::kInterval);
  consent.Answered(3);
  consent.Answered(1);
  EXPECT_EQ(consent.answered(), kConsentStart + 3 * Consent::kInterval);
  // Forgotten: newer challenges have taken its place.
  for (int i = 6; i <= 25; ++i) consent.Sent(i, kConsentStart + i * Consent::kInterval);
  consent.Answered(5);
  EXPECT_EQ(consent.answered(), kConsentStart + 3 * Consent::kInterval);
}

TEST(Consent, ChallengesComeFasterWhenAnswersAreLost) {
  Consent consent;
  consent.Begin(kConsentStart);
  EXPECT_TRUE(consent.ChallengeDue(kConsentStart));
  consent.Sent(1, kConsentStart);
  EXPECT_FALSE(consent.ChallengeDue(kConsentStart + Consent::kInterval - Time{1}));
  EXPECT_TRUE(consent.ChallengeDue(kConsentStart + Consent::kInterval));
  const Time late = kConsentStart + Consent::kOverdue + Time{1};
  consent.Sent(2, late);
  EXPECT_FALSE(consent.ChallengeDue(late + Consent::kUrgentInterval - Time{1}));
  EXPECT_TRUE(consent.ChallengeDue(late + Consent::kUrgentInterval));
}

// The daemon's side, with a subscriber whose address answers or not.
class HubConsentTest : public HubTest {
 protected:
  void SetUp() override {
    HubTest::SetUp();
    Connect(&sender);
    Publish(sender, "ann");
    Connect(&viewer, Transport::kUdp);
    ASSERT_NE(Watch(viewer, {.subject = "ann"}), 0);
  }
  // One tick with a pose. Returns the number of weight frames that the viewer received.
  int Step() {
    Advance(0.1);
    hub->Tick(now);
    Send(sender, Pose(1), 1, sequence++);
    int weights = 0;
    while (!viewer.inbox.empty()) {
      protocol::MessageView view;
      const std::vector<std::uint8_t> message = viewer.inbox.front();
      viewer.inbox.pop_front();
      EXPECT_EQ(protocol::OpenMessage(message, view), protocol::DecodeStatus::kOk);
      weights += view.kind == protocol::MessageKind::kWeights ? 1 : 0;
      protocol::Ping ping;
      if (view.kind != protocol::MessageKind::kPing) continue;
      EXPECT_EQ(protocol::Decode(view, ping), protocol::DecodeStatus::kOk);
      asked = ping.time_us;
      if (answers) Send(viewer, protocol::Pong{ping.time_us, 0});
    }
    return weights;
  }
  int Steps(int count) {
    int weights = 0;
    for (int i = 0; i < count; ++i) weights += Step();
    return weights;
  }

  FakePeer sender;
  FakePeer viewer;
  std::uint32_t sequence = 0;
  bool answers = true;
  std::int64_t asked = 0;
};

TEST_F(HubConsentTest, FramesFlowWhileTheAddressAnswers) {
  EXPECT_EQ(Steps(200), 200);
  EXPECT_EQ(hub->num_subscriptions(), 1u);
}

TEST_F(HubConsentTest, PingsAndWrongAnswersRenewNothing) {
  Steps(1);
  answers = false;
  int weights = 0;
  for (int i = 0; i < 49; ++i) {
    weights += Step();
    Send(viewer, protocol::Ping{i});
    Send(viewer, protocol::Pong{asked + 1, 0});
    Send(viewer, protocol::Pong{0, 0});
  }
  EXPECT_LE(weights, 20) << "two seconds of frames";
  EXPECT_EQ(hub->num_subscriptions(), 1u) << "it may have lost some challenges";
  Steps(3);
  EXPECT_EQ(hub->num_subscriptions(), 0u);
}

TEST_F(HubConsentTest, FramesResumeWithTheNextAnswer) {
  answers = false;
  Steps(30);
  EXPECT_EQ(Steps(5), 0);
  answers = true;
  Steps(6);  // until the next challenge
  EXPECT_EQ(Steps(20), 20);
}

TEST_F(HubConsentTest, ARequestWaitsForAnAnswer) {
  answers = false;
  Steps(60);
  ASSERT_EQ(hub->num_subscriptions(), 0u);
  EXPECT_EQ(Watch(viewer, {.subject = "ann"}, 2), 0) << "a forged one would cost this address";
  Send(viewer, protocol::Unsubscribe{}, 1);
  Send(viewer, protocol::ListSubjects{});
  EXPECT_EQ(viewer.Take<protocol::ErrorMessage>()->message.code, protocol::ErrorCode::kNeedsTcp)
      << "small answers need no consent";
  EXPECT_EQ(hub->num_subscriptions(), 0u);
  answers = true;
  Steps(5);
  EXPECT_NE(Watch(viewer, {.subject = "ann"}, 2), 0);
}

TEST_F(HubConsentTest, TheNextProgramOfAnAddressInheritsItsConsent) {
  answers = false;
  Steps(30);
  FakePeer next;
  Connect(&next, Transport::kUdp);
  hub->SetConsent(next.id, *hub->ConsentOf(viewer.id));
  EXPECT_EQ(Watch(next, {.subject = "ann"}), 0);
}

TEST_F(HubConsentTest, ManyForgedRequestsGetFewBytes) {
  answers = false;
  Steps(1);
  viewer.bytes_received = 0;
  for (int i = 0; i < 5000; ++i) {
    Send(viewer, protocol::SubscribeWeights{.subject = "ann"}, 0, 1);
    viewer.inbox.clear();
  }
  EXPECT_LE(viewer.bytes_received, Consent::kReplyBytes);
}

}  // namespace
}  // namespace furrow::server

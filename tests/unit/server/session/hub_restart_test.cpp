// SPDX-License-Identifier: Apache-2.0
// A hub that takes the place of another one.
#include <memory>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "hub_fixture.h"

namespace furrow::server {
namespace {

class HubRestartTest : public HubPeersTest {
 protected:
  void SetUp() override {
    Make({}, /*filter=*/true);
    Connect(&sender);
    Connect(&viewer);
  }

  void SendPose(std::uint32_t sequence) {
    Advance(0.02);
    Send(sender, Pose(0.1f * static_cast<float>(sequence % 7)), 1, sequence, 20'000 * sequence);
  }
  std::optional<std::vector<float>> Weights() {
    std::optional<std::vector<float>> values;
    while (!viewer.inbox.empty()) {
      if (const auto got = viewer.Take<protocol::WeightFrame>()) values = got->message.values;
    }
    return values;
  }

  struct Saved {
    std::optional<SavedPeer> sender;
    std::optional<SavedPeer> viewer;
    std::vector<SavedSubject> subjects;
  };
  Saved Save() {
    return {hub->SavePeer(sender.id), hub->SavePeer(viewer.id), hub->SaveSubjects(now)};
  }
  // Another hub. `with_sender`: the publisher is there.
  void Restart(const Saved& saved, double away = 0.0, bool with_sender = true) {
    Advance(away);
    Make({}, /*filter=*/true);
    sender.inbox.clear();
    viewer.inbox.clear();
    Connect(&viewer);  // gets another number than before
    Connect(&sender);
    Hub::ResumedPeers peers;
    if (saved.viewer) peers[saved.viewer->id] = {viewer.id, &*saved.viewer};
    if (with_sender) peers[saved.sender->id] = {sender.id, &*saved.sender};
    hub->Resume(saved.subjects, peers, FromSeconds(away), now);
  }
  Subject* Ada() { return hub->FindSubject("ada"); }
};

TEST_F(HubRestartTest, WeightsGoOnAsIfNothingHadHappened) {
  Publish(sender, "ada");
  const std::uint16_t id = Watch(viewer, {.subject = "ada", .pattern = "brow*"});
  ASSERT_NE(id, 0);
  for (std::uint32_t i = 1; i <= 9; ++i) SendPose(i);
  const Saved saved = Save();
  const Time then = now;
  viewer.inbox.clear();
  SendPose(10);
  const auto wanted = Weights();
  ASSERT_TRUE(wanted.has_value());
  now = then;

  Restart(saved);
  const auto reply = viewer.Take<protocol::SubscribeReply>();
  ASSERT_TRUE(reply.has_value());
  EXPECT_EQ(reply->header.stream, id);
  EXPECT_EQ(reply->header.sequence, 1u);
  EXPECT_EQ(reply->message.names, (std::vector<std::string>{"brow.squash"}));
  EXPECT_TRUE(sender.inbox.empty());
  // A pose that comes twice does not count, and the next one does.
  Send(sender, Pose(0.9f), 1, 9, 180'000);
  EXPECT_EQ(Count(Counter::kPosesDuplicate) + Count(Counter::kPosesLate), 1u);
  EXPECT_FALSE(Weights().has_value());
  SendPose(10);
  EXPECT_EQ(Weights(), wanted);
}

TEST_F(HubRestartTest, TheHubSaysNoGoodbyeToThoseWhoGoOn) {
  Publish(sender, "ada");
  ASSERT_TRUE(hub->SavePeer(sender.id).has_value());
  hub->Drain(now);
  EXPECT_TRUE(sender.inbox.empty());
  EXPECT_TRUE(viewer.Take<protocol::Goodbye>().has_value());
}

TEST_F(HubRestartTest, TheHubSaysGoodbyeIfNobodyTakesThem) {
  ASSERT_TRUE(hub->SavePeer(sender.id).has_value());
  hub->KeepPeers();
  hub->Drain(now);
  EXPECT_TRUE(sender.Take<protocol::Goodbye>().has_value());
}

// The publisher comes by another connection, and finds its subject.
TEST_F(HubRestartTest, ASubjectWaitsForItsPublisher) {
  Publish(sender, "ada");
  ASSERT_NE(Watch(viewer, {.subject = "ada"}), 0);
  for (std::uint32_t i = 1; i <= 3; ++i) SendPose(i);
  Restart(Save(), 0.3, /*with_sender=*/false);
  ASSERT_NE(Ada(), nullptr);
  EXPECT_TRUE(Ada()->orphaned);
  EXPECT_TRUE(viewer.Take<protocol::SubscribeReply>().has_value());
  Publish(sender, "ada");
  SendPose(4);
  EXPECT_TRUE(Weights().has_value());
}

// The time in between is nobody's silence.
TEST_F(HubRestartTest, NobodyHasBeenSilentMeanwhile) {
  Publish(sender, "ada");
  SendPose(1);
  const Limits limits;
  Restart(Save(), limits.idle_seconds + 1.0);
  hub->Tick(now);
  ASSERT_NE(Ada(), nullptr);
  EXPECT_FALSE(Ada()->lost);
  EXPECT_FALSE(hub->IsIdle(sender.id, now));
}

TEST_F(HubRestartTest, ASubjectThatHasEndedStillLeaves) {
  Publish(sender, "ada");
  ASSERT_NE(Watch(viewer, {.subject = "ada", .wait = true}), 0);
  SendPose(1);
  Send(sender, protocol::Goodbye{}, 1);
  Restart(Save());
  for (int i = 0; i < 2000 && Ada() != nullptr; ++i) {
    Advance(0.02);
    hub->Tick(now);
  }
  EXPECT_EQ(Ada(), nullptr);
  while (viewer.inbox.size() > 1) viewer.inbox.pop_front();
  const auto goodbye = viewer.Take<protocol::Goodbye>();
  ASSERT_TRUE(goodbye.has_value());
  EXPECT_EQ(goodbye->message.reason, protocol::GoodbyeReason::kSubjectGone);
}

TEST_F(HubRestartTest, RatesFormatsAndPosesGoOn) {
  Publish(sender, "ada");
  const std::uint16_t poses = [&] {
    Send(viewer, protocol::SubscribePoses{.subject = "ada"}, 0, 5);
    const auto reply = viewer.Take<protocol::SubscribeReply>();
    return reply ? reply->header.stream : std::uint16_t{0};
  }();
  ASSERT_NE(poses, 0);
  viewer.inbox.clear();
  const std::uint16_t bytes = Watch(viewer,
                                    {.subject = "ada",
                                     .max_rate_hz = 10.0f,
                                     .format = protocol::WeightFormat::kU8,
                                     .source = protocol::WeightSource::kDriverValues},
                                    6);
  ASSERT_NE(bytes, 0);
  const std::uint64_t run = Ada()->run;
  Restart(Save());
  EXPECT_EQ(Ada()->run, run);
  const auto first = viewer.Take<protocol::SubscribeReply>();
  ASSERT_TRUE(first.has_value());
  EXPECT_EQ(first->header.stream, poses);
  EXPECT_EQ(first->message.publisher_session, run);
  EXPECT_TRUE(viewer.Take<protocol::SkeletonOffer>().has_value());
  const auto second = viewer.Take<protocol::SubscribeReply>();
  ASSERT_TRUE(second.has_value());
  EXPECT_EQ(second->header.stream, bytes);
  int frames = 0;
  for (std::uint32_t i = 1; i <= 50; ++i) {
    SendPose(i);
    while (!viewer.inbox.empty()) {
      protocol::MessageView view;
      ASSERT_EQ(protocol::OpenMessage(viewer.inbox.front(), view), protocol::DecodeStatus::kOk);
      frames += view.kind == protocol::MessageKind::kWeights ? 1 : 0;
      viewer.inbox.pop_front();
    }
  }
  EXPECT_EQ(frames, 10);  // of one second
  // New subscriptions get new numbers.
  EXPECT_GT(Watch(viewer, {.subject = "ada"}, 7), bytes);
}

TEST_F(HubRestartTest, PictureViewersAndStrangersDoNotGoOn) {
  Send(viewer, protocol::SubscribePictures{.wait = true}, 0, 1);
  EXPECT_FALSE(hub->MaySavePeer(viewer.id));
  EXPECT_FALSE(hub->SavePeer(viewer.id).has_value());
  EXPECT_TRUE(hub->MaySavePeer(sender.id));
  EXPECT_FALSE(hub->MaySavePeer(12345));
  EXPECT_FALSE(hub->SavePeer(12345).has_value());
}

// Whatever a state says, the new hub goes on without what it cannot use.
TEST_F(HubRestartTest, InvalidMessagesAreLeftOut) {
  Publish(sender, "ada");
  ASSERT_NE(Watch(viewer, {.subject = "ada"}), 0);
  SendPose(1);
  const Saved good = Save();
  const auto cut_short = [](SavedMessage message) {
    message.resize(message.size() / 2);
    return message;
  };
  Saved bad = good;
  bad.subjects[0].offer = cut_short(bad.subjects[0].offer);
  Restart(bad);
  EXPECT_EQ(Ada(), nullptr);
  bad = good;
  bad.subjects[0].state = bad.subjects[0].offer;
  Restart(bad);
  EXPECT_EQ(Ada(), nullptr);
  bad = good;
  SavedMessage& request = bad.viewer->subscriptions[0].request;
  request = cut_short(request);
  bad.subjects.push_back(bad.subjects[0]);  // twice
  Restart(bad);
  EXPECT_EQ(hub->num_subjects(), 1u);
  EXPECT_EQ(hub->num_subscriptions(), 0u);
}

}  // namespace
}  // namespace furrow::server

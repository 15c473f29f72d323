// SPDX-License-Identifier: Apache-2.0
// Publishing: offers, poses in and out of order, restarts, losses.
#include <algorithm>
#include <new>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/allocation_counter.h"
#include "tests/unit/server/session/hub_fixture.h"

namespace furrow::server {
namespace {

using protocol::SkeletonStatus;
using testing::ElementsAre;
using testing::FloatEq;
using testing::HasSubstr;

class PublishersTest : public HubPeersTest {};

TEST_F(PublishersTest, APoseBecomesWeightsWithItsSequenceAndCaptureTime) {
  Publish(sender, "ann");
  const std::uint16_t id = Watch(viewer, {.subject = "ann"});
  Send(sender, Pose(0.25f, 1.0f), 1, 5, 123456);
  const auto frame = viewer.Take<protocol::WeightFrame>();
  ASSERT_TRUE(frame.has_value());
  EXPECT_EQ(frame->header.stream, id);
  EXPECT_EQ(frame->header.session, 4242u);
  EXPECT_EQ(frame->header.sequence, 5u);
  EXPECT_EQ(frame->header.capture_time_us, 123456);
  EXPECT_EQ(frame->message.age_us, 0);
  EXPECT_THAT(frame->message.values, ElementsAre(FloatEq(0.25f), FloatEq(1.0f)));
}

TEST_F(PublishersTest, AnOfferThatLacksMemoryLeavesNoHalfSubject) {
  bool failed = true;
  for (std::uint64_t allowed = 0; failed; ++allowed) {
    SCOPED_TRACE(allowed);
    Make({});
    Connect(&sender);
    Connect(&viewer);
    std::vector<std::uint8_t> offer;
    encoder.Encode({sender.session, 1, 0, 0}, Offer("ann"), offer);
    failed = false;
    try {
      const furrow::test::AllocationLimit limit(allowed);
      hub->OnMessage(sender.id, offer, now);
    } catch (const std::bad_alloc&) {
      failed = true;
    }
    ASSERT_LT(allowed, 10'000u);
    for (const auto& subject : hub->subjects().all()) {
      ASSERT_NE(subject->pipeline, nullptr);
      ASSERT_NE(subject->offer, nullptr);
      ASSERT_EQ(hub->RequireAllDrivers(subject->name), subject.get());
    }
    Advance(0.01);
    hub->Tick(now);
    // The sender repeats its offer.
    sender.inbox.clear();
    Publish(sender, "ann");
    Watch(viewer, {.subject = "ann"});
    Send(sender, Pose(0.25f, 1.0f), 1, 5, 123456);
    const auto frame = viewer.Take<protocol::WeightFrame>();
    ASSERT_TRUE(frame.has_value());
    ASSERT_THAT(frame->message.values, ElementsAre(FloatEq(0.25f), FloatEq(1.0f)));
    viewer.inbox.clear();
  }
}

TEST_F(PublishersTest, APartialPoseKeepsTheOtherValues) {
  Publish(sender, "ann");
  Watch(viewer, {.subject = "ann"});
  Send(sender, Pose(0.25f, 0.5f), 1, 0);
  protocol::PoseFrame partial = Pose(0, 0);
  partial.partial = true;
  partial.blend_shape_indices = {1};
  partial.blend_shapes = {0.75f};
  Send(sender, partial, 1, 1);
  partial.partial = false;
  Send(sender, partial, 1, 2);
  viewer.Take<protocol::WeightFrame>();
  EXPECT_THAT(viewer.Take<protocol::WeightFrame>()->message.values,
              ElementsAre(FloatEq(0.25f), FloatEq(0.75f)));
  EXPECT_THAT(viewer.Take<protocol::WeightFrame>()->message.values,
              ElementsAre(FloatEq(0.0f), FloatEq(0.75f)));
}

TEST_F(PublishersTest, UnknownStreamsAreAskedForSkeletonsOncePerInterval) {
  for (std::uint32_t i = 0; i < 10; ++i) Send(sender, Pose(1), 3, i);
  const auto reply = sender.Take<protocol::SkeletonReply>();
  ASSERT_TRUE(reply.has_value());
  EXPECT_EQ(reply->message.status, SkeletonStatus::kNeeded);
  EXPECT_EQ(reply->header.stream, 3);
  EXPECT_TRUE(sender.inbox.empty());
  Advance(0.25);
  Send(sender, Pose(1), 3, 11);
  EXPECT_EQ(sender.inbox.size(), 1u);
  EXPECT_EQ(Count(Counter::kPosesUnknownStream), 11u);
  EXPECT_EQ(Count(Counter::kSkeletonsRequested), 2u);
}

TEST_F(PublishersTest, EachUnknownStreamIsAskedForItsSkeleton) {
  for (const std::uint16_t stream : {3, 4, 3, 4}) Send(sender, Pose(1), stream);
  EXPECT_EQ(sender.Take<protocol::SkeletonReply>()->header.stream, 3);
  EXPECT_EQ(sender.Take<protocol::SkeletonReply>()->header.stream, 4);
  EXPECT_TRUE(sender.inbox.empty());
}

TEST_F(PublishersTest, NewSkeletonsAreThrottled) {
  protocol::SkeletonOffer offer = Offer("ann");
  const auto offer_another = [&](int number) {
    offer.blend_shape_names = {"brow", "shape" + std::to_string(number)};
    Send(sender, offer, 1);
    return !sender.inbox.empty() &&
           sender.Take<protocol::SkeletonReply>()->message.status == SkeletonStatus::kAccepted;
  };
  int accepted = 0;
  while (accepted < 1000 && offer_another(accepted)) ++accepted;
  EXPECT_EQ(accepted, static_cast<int>(Publishers::kNewSkeletonsBurst / 2) +
                          static_cast<int>(Publishers::kReservedPerHost));
  EXPECT_EQ(Count(Counter::kSkeletonsThrottled), 1u);
  EXPECT_TRUE(offer_another(accepted - 1)) << "one that is known";
  Advance(2.1 / Publishers::kNewSkeletonsPerSecond);
  EXPECT_TRUE(offer_another(accepted));
  EXPECT_FALSE(offer_another(accepted + 1));
}

// Each of them may use up half of what is common.
TEST_F(PublishersTest, FloodsOfSomeHostsLeaveNewSkeletonsToOthers) {
  FakePeer floods[3];
  int number = 0;
  const auto offer_another = [&](FakePeer& peer) {
    protocol::SkeletonOffer offer = Offer("subject" + std::to_string(number));
    offer.blend_shape_names = {"brow", "shape" + std::to_string(number++)};
    Send(peer, offer, 1);
    const auto reply = peer.Take<protocol::SkeletonReply>();
    return reply.has_value() && reply->message.status == SkeletonStatus::kAccepted;
  };
  const auto connect = [this](FakePeer* peer, const std::string& host) {
    peer->id = hub->AddPeer(Transport::kTcp, {"fake", host}, peer, now);
  };
  for (int i = 0; i < 3; ++i) connect(&floods[i], "192.0.2." + std::to_string(i + 1));
  for (int second = 0; second < 3; ++second) {
    for (FakePeer& flood : floods) {
      for (int i = 0; i < 200; ++i) (void)offer_another(flood);
    }
    // One of 1,024 hosts shares its rate with a flood (HostRates), so not every newcomer counts.
    int accepted = 0;
    for (int i = 0; i < 4; ++i) {
      FakePeer newcomer;
      connect(&newcomer, "198.51.100." + std::to_string(4 * second + i + 1));
      if (offer_another(newcomer)) ++accepted;
      hub->RemovePeer(newcomer.id);
    }
    EXPECT_GE(accepted, 2) << second;
    Advance(1.0);
  }
}

TEST_F(PublishersTest, TheNeutralSurvivesARestartWithTheSameSkeleton) {
  Publish(sender, "ann");
  ASSERT_NE(Watch(viewer, {.subject = "ann"}), 0);  // evaluates its weights
  Send(sender, Pose(0.25f), 1, 1);
  Subject& subject = *hub->RequireAllDrivers("ann");
  hub->SetNeutral(subject, subject.pipeline->pose(), now);
  ++sender.session;
  Publish(sender, "ann");
  Send(sender, Pose(0.75f), 1, 1);
  EXPECT_NEAR(subject.pipeline->wrinkle_weights()[0], 0.5f, 1e-6f);

  protocol::SkeletonOffer other = Offer("ann");
  other.blend_shape_names.push_back("jaw");
  Send(sender, other, 1);
  EXPECT_FALSE(subject.pipeline->neutral_pose().has_value());
}

TEST_F(PublishersTest, LateAndDuplicatePosesAreDroppedAndCounted) {
  Publish(sender, "ann");
  Watch(viewer, {.subject = "ann"});
  for (const std::uint32_t sequence : {1u, 3u, 2u, 3u, 2u, 4u}) Send(sender, Pose(1), 1, sequence);
  std::vector<std::uint32_t> seen;
  while (!viewer.inbox.empty())
    seen.push_back(viewer.Take<protocol::WeightFrame>()->header.sequence);
  EXPECT_THAT(seen, ElementsAre(1, 3, 4));
  EXPECT_EQ(Count(Counter::kPosesLate) + Count(Counter::kPosesDuplicate), 3u);
}

TEST_F(PublishersTest, APoseWithOtherCountsIsInvalid) {
  Publish(sender, "ann");
  Watch(viewer, {.subject = "ann"});
  protocol::PoseFrame wrong = Pose(1, 1);
  wrong.num_blend_shapes = 3;
  Send(sender, wrong, 1, 9);
  EXPECT_TRUE(viewer.inbox.empty());
  EXPECT_EQ(Count(Counter::kPosesInvalid), 1u);
  Send(sender, Pose(1), 1, 0);  // the invalid pose did not move the window
  EXPECT_EQ(viewer.inbox.size(), 1u);
}

TEST_F(PublishersTest, ALiveSubjectIsNotTakenOver) {
  Publish(sender, "ann");
  Watch(viewer, {.subject = "ann"});
  Send(sender, Pose(1), 1, 500);
  FakePeer other;
  other.session = 78;
  Connect(&other);
  Send(other, Offer("ann"), 1);
  const auto error = other.Take<protocol::ErrorMessage>();
  ASSERT_TRUE(error.has_value());
  EXPECT_EQ(error->message.code, protocol::ErrorCode::kSubjectTaken);
  EXPECT_THAT(error->message.message, HasSubstr("another sender is sending 'ann'"));
  EXPECT_EQ(Count(Counter::kSubjectsContested), 1u);
  Send(other, Pose(0.5f), 1, 600);
  Send(sender, Pose(1), 1, 501);
  EXPECT_EQ(viewer.inbox.size(), 2u) << "the poses of the first sender";
}

TEST_F(PublishersTest, ASilentSubjectIsTakenOver) {
  Publish(sender, "ann");
  Watch(viewer, {.subject = "ann"});
  Send(sender, Pose(1), 1, 500);
  FakePeer other;
  other.session = 78;
  Connect(&other);
  Advance(0.51);
  Publish(other, "ann");
  Send(other, Pose(0.5f), 1, 0);
  EXPECT_EQ(viewer.inbox.size(), 2u);
  EXPECT_EQ(Count(Counter::kSubjectsRestarted), 1u);
  // The first one is a stranger now, and the subject is not its own.
  Send(sender, Pose(1), 1, 501);
  EXPECT_EQ(viewer.inbox.size(), 2u);
  EXPECT_EQ(sender.Take<protocol::SkeletonReply>()->message.status, SkeletonStatus::kNeeded);
  Send(sender, Offer("ann"), 1);
  EXPECT_EQ(sender.Take<protocol::ErrorMessage>()->message.code,
            protocol::ErrorCode::kSubjectTaken);
}

TEST_F(PublishersTest, ASubjectWhoseSenderHasLeftIsFree) {
  Publish(sender, "ann");
  Send(sender, Pose(1), 1, 0);
  FakePeer other;
  other.session = 78;
  Connect(&other);
  Send(sender, protocol::Goodbye{}, 1);
  Publish(other, "ann");
  Send(other, Pose(1), 1, 0);
  hub->RemovePeer(other.id);  // its connection has closed
  Publish(sender, "ann");
  Send(sender, Pose(1), 1, 0);
  EXPECT_EQ(hub->num_subjects(), 1u);
  EXPECT_EQ(Count(Counter::kPosesLate), 0u);
}

TEST_F(PublishersTest, ASenderKeepsItsSubjectWhenItsAddressChanges) {
  for (const Transport transport : {Transport::kTcp, Transport::kUdp}) {
    Make({});
    FakePeer first;
    FakePeer second;
    Connect(&first, transport);
    Connect(&second, transport);
    Publish(first, "ann");
    Send(first, Pose(1), 1, 0);
    second.session = first.session;
    Publish(second, "ann");
    Send(second, Pose(1), 1, 1);
    EXPECT_EQ(Count(Counter::kPosesLate), 0u);
  }
}

TEST_F(PublishersTest, NoSessionOpensASubjectOfAForeignWireOrARecording) {
  for (const Transport transport : {Transport::kMocap, Transport::kWeb}) {
    Make({});
    FakePeer owner;
    FakePeer thief;
    Connect(&owner, transport);
    Connect(&thief);
    Send(owner, Offer("ann"), 1);
    Send(owner, Pose(1), 1, 0);
    ASSERT_EQ(hub->num_subjects(), 1u);
    thief.session = owner.session;  // these sessions can be guessed
    Send(thief, Offer("ann"), 1);
    EXPECT_EQ(thief.Take<protocol::ErrorMessage>()->message.code,
              protocol::ErrorCode::kSubjectTaken);
  }
}

TEST_F(PublishersTest, NoHostTakesAllPlaces) {
  Limits limits;
  limits.max_subjects = 6;
  Make(limits);
  FakePeer greedy;
  greedy.id = hub->AddPeer(Transport::kTcp, {"greedy", "10.0.0.1"}, &greedy, now);
  FakePeer modest;
  modest.id = hub->AddPeer(Transport::kTcp, {"modest", "10.0.0.2"}, &modest, now);
  const char* const names[] = {"a", "b", "c"};
  for (std::uint16_t i = 0; i < 3; ++i) Publish(greedy, names[i], i);
  Send(greedy, Offer("d"), 3);
  EXPECT_EQ(greedy.Take<protocol::SkeletonReply>()->message.status, SkeletonStatus::kRejected);
  Publish(modest, "new", 1);
  // A subject that has left gives its place back.
  Send(greedy, protocol::Goodbye{}, 0);
  hub->Tick(now);
  ASSERT_EQ(hub->num_subjects(), 3u);
  Send(modest, Offer("second"), 2);
  EXPECT_EQ(modest.Take<protocol::SkeletonReply>()->message.status, SkeletonStatus::kAccepted);
}

TEST_F(PublishersTest, RepeatingAnOfferChangesNothing) {
  Publish(sender, "ann");
  Watch(viewer, {.subject = "ann"});
  Send(sender, Pose(1), 1, 7);
  Publish(sender, "ann");
  Send(sender, Pose(1), 1, 7);
  EXPECT_EQ(viewer.inbox.size(), 1u);
  EXPECT_EQ(Count(Counter::kPosesDuplicate), 1u);
}

TEST_F(PublishersTest, AnOfferBeyondTheLimitIsRejectedWithItsReason) {
  Limits limits;
  limits.max_subjects = 1;
  Make(limits);
  Connect(&sender);
  Publish(sender, "ben");
  Send(sender, Offer("ann"), 2);
  const auto reply = sender.Take<protocol::SkeletonReply>();
  EXPECT_EQ(reply->message.status, SkeletonStatus::kRejected);
  EXPECT_THAT(reply->message.message, HasSubstr("limits.max_subjects"));
  EXPECT_EQ(Count(Counter::kSkeletonsRejected), 1u);
}

TEST_F(PublishersTest, SubjectsOfOneSenderAreSeparate) {
  Publish(sender, "ann", 1);
  Publish(sender, "ben", 2);
  const std::uint16_t ben = Watch(viewer, {.subject = "ben"});
  Send(sender, Pose(0.2f), 1, 0);
  Send(sender, Pose(0.8f), 2, 0);
  ASSERT_EQ(viewer.inbox.size(), 1u);
  const auto frame = viewer.Take<protocol::WeightFrame>();
  EXPECT_EQ(frame->header.stream, ben);
  EXPECT_FLOAT_EQ(frame->message.values[0], 0.8f);
}

TEST_F(PublishersTest, ASilentSubjectHoldsThenDecays) {
  Make({}, /*filter=*/true);
  Connect(&sender);
  Connect(&viewer);
  Publish(sender, "ann");
  Watch(viewer, {.subject = "ann"});
  Send(sender, Pose(1), 1, 0);
  viewer.Take<protocol::WeightFrame>();
  Advance(0.2);
  hub->Tick(now);
  EXPECT_TRUE(viewer.inbox.empty()) << "not lost yet";
  float last = 1.0f;
  std::int64_t age = 0;
  for (int i = 0; i < 1000; ++i) {
    Advance(0.02);
    hub->Tick(now);
    while (!viewer.inbox.empty()) {
      const auto frame = viewer.Take<protocol::WeightFrame>();
      EXPECT_EQ(frame->header.sequence, 0u);
      EXPECT_LE(frame->message.values[0], last);
      EXPECT_GT(frame->message.age_us, age);
      last = frame->message.values[0];
      age = frame->message.age_us;
    }
  }
  EXPECT_LT(last, 0.5f / 255.0f);
  EXPECT_EQ(Count(Counter::kSubjectsLost), 1u);
  // A pose that arrives after all revives the subject.
  Send(sender, Pose(1), 1, 1);
  EXPECT_EQ(viewer.inbox.size(), 1u);
}

// The poses of the stall wait in the socket, so weights go on as if nothing had happened.
TEST_F(PublishersTest, AStallOfTheDaemonIsNoSilenceOfItsSubjects) {
  const auto weights_with_stall = [this](double seconds) {
    Make({}, /*filter=*/true);
    Connect(&sender);
    Connect(&viewer);
    Publish(sender, "ann");
    Watch(viewer, {.subject = "ann"});
    Send(sender, Pose(0.9f), 1, 0, 1'000'000);
    Advance(seconds);
    hub->Tick(now, FromSeconds(seconds));
    Send(sender, Pose(0.5f), 1, 1, 1'016'667);
    std::vector<float> values;
    while (!viewer.inbox.empty()) {
      const auto frame = viewer.Take<protocol::WeightFrame>();
      EXPECT_EQ(frame->message.age_us, 0) << "the subject counts as silent";
      values.push_back(frame->message.values[0]);
    }
    return values;
  };
  const std::vector<float> wanted = weights_with_stall(0.016667);
  ASSERT_EQ(wanted.size(), 2u);
  EXPECT_EQ(weights_with_stall(3.0), wanted);
  EXPECT_EQ(weights_with_stall(100.0), wanted) << "longer than idle_seconds";
  EXPECT_EQ(Count(Counter::kSubjectsLost), 0u);
  EXPECT_EQ(Count(Counter::kStalls), 2u);
}

TEST_F(PublishersTest, SilenceAfterAStallDecaysWithoutAJump) {
  Make({}, /*filter=*/true);
  Connect(&sender);
  Connect(&viewer);
  Publish(sender, "ann");
  Watch(viewer, {.subject = "ann"});
  Send(sender, Pose(1), 1, 0);
  viewer.Take<protocol::WeightFrame>();
  Advance(5.0);
  hub->Tick(now, FromSeconds(5.0));
  Advance(0.49);
  hub->Tick(now);
  EXPECT_TRUE(viewer.inbox.empty()) << "the sender has half a second again";
  Advance(0.02);
  hub->Tick(now);
  const auto frame = viewer.Take<protocol::WeightFrame>();
  ASSERT_TRUE(frame.has_value());
  EXPECT_GT(frame->message.values[0], 0.5f) << "not as far as after five seconds of silence";
  EXPECT_EQ(frame->message.age_us, 5'510'000);
}

TEST_F(PublishersTest, AStallOfTheDaemonGivesNoSubjectAway) {
  FakePeer other;
  other.session = 78;
  Connect(&other);
  Publish(sender, "ann");
  Send(sender, Pose(1), 1, 0);
  Advance(3.0);
  hub->Tick(now, FromSeconds(3.0));
  Send(other, Offer("ann"), 1);
  ExpectError(other, protocol::ErrorCode::kSubjectTaken);
}

TEST_F(PublishersTest, AGoodbyeDecaysTheSubjectThenInformsSubscribers) {
  Make({}, /*filter=*/true);
  Connect(&sender);
  Connect(&viewer);
  Publish(sender, "ann");
  const std::uint16_t id = Watch(viewer, {.subject = "ann"});
  Send(sender, Pose(1), 1, 0);
  Send(sender, protocol::Goodbye{}, 1);
  for (int i = 0; i < 1000; ++i) {
    Advance(0.02);
    hub->Tick(now);
  }
  while (viewer.inbox.size() > 1) viewer.Take<protocol::WeightFrame>();
  const auto goodbye = viewer.Take<protocol::Goodbye>();
  ASSERT_TRUE(goodbye.has_value());
  EXPECT_EQ(goodbye->message.reason, protocol::GoodbyeReason::kSubjectGone);
  EXPECT_EQ(goodbye->header.stream, id);
  EXPECT_EQ(hub->num_subjects(), 0u);
  EXPECT_EQ(hub->num_subscriptions(), 0u);
}

// A random network that loses, repeats and reorders poses. Output is in order and without
// duplicates, and every input is counted.
TEST_F(PublishersTest, ABadNetworkOnlyLosesFrames) {
  Publish(sender, "ann");
  Watch(viewer, {.subject = "ann"});
  std::mt19937 random(20240611);
  std::vector<std::pair<double, std::uint32_t>> arrivals;
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (std::uint32_t sequence = 0; sequence < 5000; ++sequence) {
    if (uniform(random) < 0.05) continue;
    const double sent = sequence / 60.0;
    arrivals.emplace_back(sent + 0.04 * uniform(random), sequence);
    if (uniform(random) < 0.05) arrivals.emplace_back(sent + 0.1 * uniform(random), sequence);
  }
  std::ranges::sort(arrivals);
  for (const auto& [time, sequence] : arrivals) {
    now = FromSeconds(1000 + time);
    Send(sender, Pose(static_cast<float>(sequence) / 5000.0f), 1, sequence);
  }
  std::int64_t newest = -1;
  std::uint64_t used = 0;
  while (!viewer.inbox.empty()) {
    const auto frame = viewer.Take<protocol::WeightFrame>();
    EXPECT_GT(static_cast<std::int64_t>(frame->header.sequence), newest);
    newest = frame->header.sequence;
    EXPECT_FLOAT_EQ(frame->message.values[0], static_cast<float>(newest) / 5000.0f);
    ++used;
  }
  EXPECT_EQ(used + Count(Counter::kPosesLate) + Count(Counter::kPosesDuplicate), arrivals.size());
  EXPECT_GT(used, 2500u);
  EXPECT_GT(Count(Counter::kPosesLate), 0u);
  EXPECT_GT(Count(Counter::kPosesDuplicate), 0u);
}

}  // namespace
}  // namespace furrow::server

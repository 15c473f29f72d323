// SPDX-License-Identifier: Apache-2.0
#include "client/cpp/publisher.h"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "fake_transport.h"
#include "protocol/codec/codec.h"
#include "protocol/messages/hash.h"
#include "protocol/messages/limits.h"

namespace furrow::client {
namespace {

using protocol::MessageKind;
using protocol::SkeletonStatus;
using std::chrono::milliseconds;

protocol::SkeletonOffer OneJoint() {
  protocol::SkeletonOffer offer;
  offer.subject = "ada";
  offer.joints = {{.name = "root"}};
  return offer;
}

class PublisherTest : public ::testing::Test {
 protected:
  std::shared_ptr<FarEnd> far_ = std::make_shared<FarEnd>();
  Publisher publisher_{std::make_unique<FakeTransport>(TransportKind::kUdp, far_)};

  // The daemon has accepted the address; the offers of all subjects have left.
  void Prove() {
    far_->Answer({.session = 7}, protocol::Welcome{"daemon", 0});
    publisher_.Poll(0, milliseconds(0));
  }
  void Reply(std::uint16_t stream, SkeletonStatus status, const std::string& message = {},
             std::uint64_t hash = protocol::SkeletonHash(OneJoint())) {
    far_->Answer(
        {.session = 7, .stream = stream},
        protocol::SkeletonReply{.skeleton_hash = hash, .status = status, .message = message});
  }
};

TEST_F(PublisherTest, OfferIsRepeatedUntilItIsAnswered) {
  const auto stream = publisher_.AddSubject(OneJoint(), 0);
  (void)far_->TakeKinds();
  Prove();
  EXPECT_EQ(far_->TakeKinds(), std::vector{MessageKind::kSkeletonOffer});
  publisher_.Poll(100'000, milliseconds(0));
  EXPECT_TRUE(far_->sent.empty()) << "not due yet";
  publisher_.Poll(200'000, milliseconds(0));
  EXPECT_EQ(far_->TakeKinds(), std::vector{MessageKind::kSkeletonOffer});
  Reply(stream, SkeletonStatus::kAccepted);
  publisher_.Poll(300'000, milliseconds(0));
  EXPECT_TRUE(publisher_.accepted(stream));
  publisher_.Poll(900'000, milliseconds(0));
  EXPECT_TRUE(far_->sent.empty());
}

// The daemon drops offers beyond 1,000 per second.
TEST_F(PublisherTest, OffersOfManyStreamsTakeTurns) {
  constexpr std::size_t kStreams = 500;
  for (std::size_t i = 0; i < kStreams; ++i) (void)publisher_.AddSubject(OneJoint(), 0);
  Prove();
  far_->sent.clear();
  for (std::int64_t now = 10'000; now <= 1'000'000; now += 10'000) {
    publisher_.Poll(now, milliseconds(0));
  }
  EXPECT_LE(far_->sent.size(), 1'000u);
  std::set<std::uint16_t> offered;
  for (const auto& bytes : far_->sent) {
    protocol::MessageView view;
    ASSERT_EQ(protocol::OpenMessage(bytes, view), protocol::DecodeStatus::kOk);
    offered.insert(view.header.stream);
  }
  EXPECT_EQ(offered.size(), kStreams);
}

// The pose that the last message of the far end carries.
protocol::PoseFrame LastPose(const FarEnd& far) {
  protocol::MessageView view;
  protocol::PoseFrame pose;
  EXPECT_EQ(protocol::OpenMessage(far.sent.back(), view), protocol::DecodeStatus::kOk);
  EXPECT_EQ(protocol::Decode(view, pose), protocol::DecodeStatus::kOk);
  return pose;
}

TEST_F(PublisherTest, APoseRepeatsThePreviousOneWhereBothFit) {
  const auto stream = publisher_.AddSubject(OneJoint(), 0);
  protocol::PoseFrame pose;
  pose.num_joints = 1;
  pose.rotation_joints = {0};
  const auto send = [&](float angle, std::int64_t capture_us) {
    pose.rotations = {{std::sin(angle), 0.0f, 0.0f, std::cos(angle)}};
    EXPECT_EQ(publisher_.Send(stream, pose, capture_us, {}, /*repeat_previous=*/true),
              IoStatus::kOk);
    return LastPose(*far_);
  };
  const protocol::PoseFrame first = send(0.1f, 1000);
  EXPECT_TRUE(first.previous.empty());
  const protocol::PoseFrame second = send(0.2f, 17'000);
  EXPECT_EQ(second.previous_age_us, 16'000u);
  protocol::PoseFrame previous;
  ASSERT_EQ(protocol::DecodePrevious(second, previous), protocol::DecodeStatus::kOk);
  EXPECT_EQ(previous.rotations, first.rotations);
  EXPECT_TRUE(previous.previous.empty());
  // A large pose leaves no room, and neither does the one after it.
  pose.num_blend_shapes = 512;
  for (std::uint16_t i = 0; i < 512; ++i) pose.blend_shape_indices.push_back(i);
  pose.blend_shapes.assign(512, 0.5f);
  EXPECT_TRUE(send(0.3f, 33'000).previous.empty());
  EXPECT_LE(far_->sent.back().size(), protocol::kMaxDatagramBytes);
  EXPECT_TRUE(send(0.4f, 49'000).previous.empty());
  // A partial pose is not repeated.
  pose = {};
  pose.num_joints = 1;
  pose.rotation_joints = {0};
  (void)send(0.5f, 65'000);
  pose.partial = true;
  (void)send(0.6f, 81'000);
  pose.partial = false;
  EXPECT_TRUE(send(0.7f, 97'000).previous.empty());
  EXPECT_FALSE(send(0.8f, 113'000).previous.empty());
}

TEST_F(PublisherTest, WithoutTheOptionNothingIsRepeated) {
  const auto stream = publisher_.AddSubject(OneJoint(), 0);
  protocol::PoseFrame pose;
  pose.num_joints = 1;
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(publisher_.Send(stream, pose, i), IoStatus::kOk);
    EXPECT_TRUE(LastPose(*far_).previous.empty());
  }
}

TEST_F(PublisherTest, NothingIsOfferedBeforeTheAddressIsProven) {
  (void)publisher_.AddSubject(OneJoint(), 0);
  EXPECT_EQ(far_->TakeKinds(), std::vector{MessageKind::kHello});
  publisher_.Poll(100'000, milliseconds(0));
  EXPECT_TRUE(far_->sent.empty()) << "not due yet";
  publisher_.Poll(200'000, milliseconds(0));
  EXPECT_EQ(far_->TakeKinds(), std::vector{MessageKind::kHello});
  far_->Answer({.session = 7}, protocol::Welcome{"daemon", 99});
  publisher_.Poll(210'000, milliseconds(0));
  protocol::MessageView view;
  protocol::Hello hello;
  ASSERT_EQ(protocol::OpenMessage(far_->sent.back(), view), protocol::DecodeStatus::kOk);
  ASSERT_EQ(protocol::Decode(view, hello), protocol::DecodeStatus::kOk);
  EXPECT_EQ(hello.token, 99u);
  (void)far_->TakeKinds();
  Prove();
  EXPECT_EQ(far_->TakeKinds(), std::vector{MessageKind::kSkeletonOffer});
  (void)publisher_.AddSubject(OneJoint(), 0);
  EXPECT_EQ(far_->TakeKinds(), std::vector{MessageKind::kSkeletonOffer}) << "once is enough";
}

TEST_F(PublisherTest, ADaemonThatForgotTheAddressIsGreetedAgain) {
  const auto stream = publisher_.AddSubject(OneJoint(), 0);
  Prove();
  Reply(stream, SkeletonStatus::kAccepted);
  publisher_.Poll(1, milliseconds(0));
  (void)far_->TakeKinds();
  // One error for each pose that was on its way.
  for (int i = 0; i < 3; ++i) {
    far_->Answer({.session = 8},
                 protocol::ErrorMessage{protocol::ErrorCode::kUnprovenAddress, "who are you?"});
  }
  publisher_.Poll(2, milliseconds(0));
  EXPECT_EQ(far_->TakeKinds(), std::vector{MessageKind::kHello});
  EXPECT_EQ(publisher_.last_error(), "") << "nothing that a user could do";
  Prove();
  EXPECT_EQ(far_->TakeKinds(), std::vector{MessageKind::kSkeletonOffer});
  EXPECT_FALSE(publisher_.accepted(stream));
}

TEST_F(PublisherTest, ChallengesAreAnswered) {
  (void)publisher_.AddSubject(OneJoint(), 0);
  Prove();
  (void)far_->TakeKinds();
  far_->Answer({.session = 7}, protocol::Ping{123456789});
  publisher_.Poll(1, milliseconds(0));
  ASSERT_EQ(far_->sent.size(), 1u);
  protocol::MessageView view;
  protocol::Pong pong;
  ASSERT_EQ(protocol::OpenMessage(far_->sent.back(), view), protocol::DecodeStatus::kOk);
  ASSERT_EQ(protocol::Decode(view, pong), protocol::DecodeStatus::kOk);
  EXPECT_EQ(pong.time_us, 123456789);
}

TEST_F(PublisherTest, AFloodDoesNotKeepPollFromReturning) {
  (void)publisher_.AddSubject(OneJoint(), 0);
  Prove();
  for (int i = 0; i < 1000; ++i) far_->Answer({.session = 7}, protocol::Ping{i});
  EXPECT_EQ(publisher_.Poll(1, milliseconds(0)), IoStatus::kOk);
  EXPECT_EQ(far_->to_receive.size(), 1000u - 256u);
}

TEST_F(PublisherTest, ASubjectThatAnotherOneSendsIsOfferedUntilItIsFree) {
  const auto stream = publisher_.AddSubject(OneJoint(), 0);
  Prove();
  (void)far_->TakeKinds();
  far_->Answer({.session = 7, .stream = stream},
               protocol::ErrorMessage{protocol::ErrorCode::kSubjectTaken, "another one sends it"});
  publisher_.Poll(1, milliseconds(0));
  EXPECT_EQ(publisher_.last_error(), "another one sends it");
  EXPECT_EQ(publisher_.rejection(stream), "");
  publisher_.Poll(200'000, milliseconds(0));
  EXPECT_EQ(far_->TakeKinds(), std::vector{MessageKind::kSkeletonOffer});
}

TEST_F(PublisherTest, ADaemonThatAsksGetsTheOfferAtOnce) {
  const auto stream = publisher_.AddSubject(OneJoint(), 0);
  Prove();
  Reply(stream, SkeletonStatus::kAccepted);
  publisher_.Poll(1, milliseconds(0));
  (void)far_->TakeKinds();
  Reply(stream, SkeletonStatus::kNeeded);
  publisher_.Poll(2, milliseconds(0));
  EXPECT_EQ(far_->TakeKinds(), std::vector{MessageKind::kSkeletonOffer});
  EXPECT_FALSE(publisher_.accepted(stream));
}

TEST_F(PublisherTest, RejectionIsFinalAndHasAReason) {
  const auto stream = publisher_.AddSubject(OneJoint(), 0);
  Prove();
  (void)far_->TakeKinds();
  Reply(stream, SkeletonStatus::kRejected, "no joint of the rig");
  publisher_.Poll(1, milliseconds(0));
  EXPECT_EQ(publisher_.rejection(stream), "no joint of the rig");
  publisher_.Poll(900'000, milliseconds(0));
  EXPECT_TRUE(far_->sent.empty());
}

TEST_F(PublisherTest, AnOfferThatTheWireCannotCarryIsRejectedLocally) {
  protocol::SkeletonOffer offer = OneJoint();
  offer.joints[0].name = "caf\xe9";  // Latin-1
  EXPECT_NE(publisher_.rejection(publisher_.AddSubject(offer, 0)).find("UTF-8"), std::string::npos);
  offer = OneJoint();
  offer.subject = std::string(256, 'x');
  EXPECT_NE(publisher_.rejection(publisher_.AddSubject(offer, 0)).find("255"), std::string::npos);
  offer = OneJoint();
  offer.metres_per_unit = 0.0f;
  EXPECT_NE(publisher_.rejection(publisher_.AddSubject(offer, 0)), "");
  publisher_.Poll(900'000, milliseconds(0));
  EXPECT_TRUE(far_->sent.empty());
  Prove();
  far_->when_sent = IoStatus::kTooLarge;
  const auto large = publisher_.AddSubject(OneJoint(), 0);
  EXPECT_NE(publisher_.rejection(large).find("TCP"), std::string::npos);
  EXPECT_TRUE(publisher_.oversized(large));
  EXPECT_FALSE(publisher_.oversized(0)) << "invalid, not large";
}

TEST_F(PublisherTest, RepliesForOtherStreamsOrSkeletonsAreIgnored) {
  const auto stream = publisher_.AddSubject(OneJoint(), 0);
  Reply(static_cast<std::uint16_t>(stream + 9), SkeletonStatus::kAccepted);
  Reply(stream, SkeletonStatus::kAccepted, {}, 12345);
  far_->to_receive.push_back({1, 2, 3});
  publisher_.Poll(1, milliseconds(0));
  EXPECT_FALSE(publisher_.accepted(stream));
}

TEST_F(PublisherTest, PosesAreNumberedByStreamAndCarryTheHash) {
  const auto first = publisher_.AddSubject(OneJoint(), 0);
  const auto second = publisher_.AddSubject(OneJoint(), 0);
  far_->sent.clear();
  protocol::PoseFrame pose;
  pose.num_joints = 1;
  pose.rotation_joints = {0};
  pose.rotations = {{}};
  ASSERT_EQ(publisher_.Send(first, pose, 10), IoStatus::kOk);
  ASSERT_EQ(publisher_.Send(first, pose, 20), IoStatus::kOk);
  ASSERT_EQ(publisher_.Send(second, pose, 30), IoStatus::kOk);
  std::vector<std::uint32_t> sequences;
  for (const auto& bytes : far_->sent) {
    protocol::MessageView view;
    protocol::PoseFrame sent;
    ASSERT_EQ(protocol::OpenMessage(bytes, view), protocol::DecodeStatus::kOk);
    ASSERT_EQ(protocol::Decode(view, sent), protocol::DecodeStatus::kOk);
    EXPECT_EQ(sent.skeleton_hash, protocol::SkeletonHash(OneJoint()));
    sequences.push_back(view.header.sequence);
  }
  EXPECT_EQ(sequences, (std::vector<std::uint32_t>{0, 1, 0}));
}

TEST_F(PublisherTest, CloseSendsAGoodbyeForEveryStream) {
  publisher_.AddSubject(OneJoint(), 0);
  publisher_.AddSubject(OneJoint(), 0);
  far_->sent.clear();
  publisher_.Close();
  EXPECT_EQ(far_->TakeKinds(), (std::vector{MessageKind::kGoodbye, MessageKind::kGoodbye}));
}

TEST(NewSessionTest, IsNeverZeroAndNeverRepeats) {
  std::set<std::uint64_t> seen;
  for (int i = 0; i < 1000; ++i) seen.insert(NewSession());
  EXPECT_EQ(seen.size(), 1000u);
  EXPECT_FALSE(seen.contains(0));
}

const protocol::ErrorMessage kMoved{protocol::ErrorCode::kSubjectTaken, "at b", "host-b", 7, 8};

TEST_F(PublisherTest, GoesToTheServerThatTheDaemonNames) {
  const auto stream = publisher_.AddSubject(OneJoint(), 0);
  far_->follows = true;
  far_->Answer({.session = 7}, kMoved);
  publisher_.Poll(0, milliseconds(0));
  EXPECT_TRUE(far_->moves.empty()) << "the daemon is not proven yet";
  Prove();
  far_->Answer({.session = 7, .stream = stream}, kMoved);
  publisher_.Poll(0, milliseconds(0));
  EXPECT_EQ(far_->moves, (std::vector<Elsewhere>{{"host-b", 7, 8}}));
  // The other server gets the offer, and poses that are numbered on.
  far_->generation = 2;
  publisher_.Poll(0, milliseconds(0));
  (void)far_->TakeKinds();
  Prove();
  EXPECT_EQ(far_->TakeKinds(), std::vector{MessageKind::kSkeletonOffer});
}

TEST_F(PublisherTest, PosesWaitForTheServerToWhichItMoves) {
  const auto stream = publisher_.AddSubject(OneJoint(), 0);
  Prove();
  Reply(stream, SkeletonStatus::kAccepted);
  protocol::PoseFrame pose;
  pose.num_joints = 1;
  EXPECT_EQ(publisher_.Send(stream, pose, 0), IoStatus::kOk);
  far_->follows = true;
  far_->Answer({.session = 7, .stream = stream}, kMoved);
  publisher_.Poll(0, milliseconds(0));
  (void)far_->TakeKinds();
  for (int i = 0; i < 3; ++i) EXPECT_EQ(publisher_.Send(stream, pose, 0), IoStatus::kOk);
  EXPECT_TRUE(far_->sent.empty());
  far_->generation = 2;
  publisher_.Poll(0, milliseconds(0));
  Prove();
  (void)far_->TakeKinds();
  Reply(stream, SkeletonStatus::kAccepted);
  publisher_.Poll(0, milliseconds(0));
  // In their order, and those that follow leave at once.
  EXPECT_EQ(publisher_.Send(stream, pose, 0), IoStatus::kOk);
  std::vector<std::uint32_t> sequences;
  for (const auto& bytes : far_->sent) {
    protocol::MessageView view;
    ASSERT_EQ(protocol::OpenMessage(bytes, view), protocol::DecodeStatus::kOk);
    if (view.kind == MessageKind::kPose) sequences.push_back(view.header.sequence);
  }
  EXPECT_EQ(sequences, (std::vector<std::uint32_t>{1, 2, 3, 4}));
}

TEST_F(PublisherTest, PosesDoNotWaitForAServerThatNeverAnswers) {
  const auto stream = publisher_.AddSubject(OneJoint(), 0);
  Prove();
  far_->follows = true;
  far_->Answer({.session = 7, .stream = stream}, kMoved);
  publisher_.Poll(0, milliseconds(0));
  protocol::PoseFrame pose;
  pose.num_joints = 1;
  EXPECT_EQ(publisher_.Send(stream, pose, 0), IoStatus::kOk);
  publisher_.Poll(1'100'000, milliseconds(0));
  (void)far_->TakeKinds();
  EXPECT_EQ(publisher_.Send(stream, pose, 0), IoStatus::kOk);
  EXPECT_EQ(far_->TakeKinds(), std::vector{MessageKind::kPose});
}

TEST_F(PublisherTest, ForgedRedirectsAreNotFollowed) {
  const auto stream = publisher_.AddSubject(OneJoint(), 0);
  far_->follows = true;
  Prove();
  protocol::ErrorMessage other = kMoved;
  other.code = protocol::ErrorCode::kMalformed;
  const protocol::Header right{.session = 7, .stream = stream};
  far_->Answer({.session = 8, .stream = stream}, kMoved);
  far_->Answer({.session = 7, .stream = 9}, kMoved);
  far_->Answer(right, other);
  publisher_.Poll(0, milliseconds(0));
  EXPECT_TRUE(far_->moves.empty());
  far_->Answer(right, kMoved);
  publisher_.Poll(0, milliseconds(0));
  EXPECT_EQ(far_->moves.size(), 1u);
}

TEST_F(PublisherTest, WithSeveralSubjectsItStays) {
  publisher_.AddSubject(OneJoint(), 0);
  publisher_.AddSubject(OneJoint(), 0);
  Prove();
  far_->follows = true;
  far_->Answer({.session = 7}, kMoved);
  publisher_.Poll(0, milliseconds(0));
  EXPECT_TRUE(far_->moves.empty());
  EXPECT_EQ(publisher_.last_error(), "at b");
}

TEST_F(PublisherTest, ASilentServerIsLeftIfThereAreOthers) {
  publisher_.AddSubject(OneJoint(), 0);
  far_->Answer({.session = 7}, protocol::Welcome{"daemon", 0, {"host-b:7:8", "no address"}});
  publisher_.Poll(0, milliseconds(0));
  EXPECT_EQ(far_->others, (std::vector<Elsewhere>{{"host-b", 7, 8}}));
  for (std::int64_t now = 0; now <= 1'900'000; now += 100'000) {
    publisher_.Poll(now, milliseconds(0));
    EXPECT_FALSE(far_->abandoned) << now;
  }
  // Its answers to pings keep it.
  far_->Answer({.session = 7}, protocol::Pong{});
  publisher_.Poll(2'000'000, milliseconds(0));
  publisher_.Poll(3'900'000, milliseconds(0));
  EXPECT_FALSE(far_->abandoned);
  publisher_.Poll(4'100'000, milliseconds(0));
  EXPECT_TRUE(far_->abandoned);
}

}  // namespace
}  // namespace furrow::client

// SPDX-License-Identifier: Apache-2.0
#include "client/cpp/subscriber.h"

#include <gtest/gtest.h>

#include "fake_transport.h"
#include "protocol/messages/hash.h"
#include "protocol/messages/limits.h"

namespace furrow::client {
namespace {

using protocol::MessageKind;
using std::chrono::milliseconds;
using Kind = Event::Kind;

class SubscriberTest : public ::testing::Test {
 protected:
  std::shared_ptr<FarEnd> far_ = std::make_shared<FarEnd>();

  Subscriber Make(TransportKind kind) {
    return {std::make_unique<FakeTransport>(kind, far_), "test"};
  }
};

TEST_F(SubscriberTest, OverTcpRequestsAreSentAtOnce) {
  Subscriber subscriber = Make(TransportKind::kTcp);
  subscriber.Subscribe(protocol::SubscribeWeights{});
  subscriber.Subscribe(protocol::SubscribePictures{});
  EXPECT_EQ(far_->TakeKinds(), (std::vector{MessageKind::kHello, MessageKind::kSubscribeWeights,
                                            MessageKind::kSubscribePictures}));
}

TEST_F(SubscriberTest, OverUdpTheAddressIsProvenFirst) {
  Subscriber subscriber = Make(TransportKind::kUdp);
  subscriber.Subscribe(protocol::SubscribeWeights{});
  EXPECT_EQ(far_->TakeKinds(), std::vector{MessageKind::kHello});

  far_->Answer({.session = 5}, protocol::Welcome{.server = "furrowd", .token = 99});
  EXPECT_EQ(subscriber.Next(0, milliseconds(0)).kind, Kind::kTimeout);
  ASSERT_EQ(far_->sent.size(), 1u);
  protocol::MessageView view;
  protocol::Hello hello;
  ASSERT_EQ(protocol::OpenMessage(far_->sent[0], view), protocol::DecodeStatus::kOk);
  ASSERT_EQ(protocol::Decode(view, hello), protocol::DecodeStatus::kOk);
  EXPECT_EQ(hello.token, 99u);
  far_->sent.clear();

  far_->Answer({.session = 5}, protocol::Welcome{.server = "furrowd", .token = 0});
  EXPECT_EQ(subscriber.Next(1, milliseconds(0)).kind, Kind::kTimeout);
  EXPECT_EQ(far_->TakeKinds(), std::vector{MessageKind::kSubscribeWeights});
}

TEST_F(SubscriberTest, BundlesAreRequestedIfTheTransportSplitsThem) {
  for (const bool takes : {false, true}) {
    far_->takes_bundles = takes;
    Subscriber subscriber = Make(TransportKind::kUdp);
    far_->Answer({.session = 5}, protocol::Welcome{.server = "furrowd", .token = 99});
    (void)subscriber.Next(0, milliseconds(0));
    ASSERT_EQ(far_->sent.size(), 2u);
    for (const auto& bytes : far_->sent) {
      protocol::MessageView view;
      protocol::Hello hello;
      ASSERT_EQ(protocol::OpenMessage(bytes, view), protocol::DecodeStatus::kOk);
      ASSERT_EQ(protocol::Decode(view, hello), protocol::DecodeStatus::kOk);
      EXPECT_EQ(hello.bundles, takes);
    }
    far_->sent.clear();
  }
}

TEST_F(SubscriberTest, LostUdpRequestsAreRepeatedAndChallengesAnswered) {
  Subscriber subscriber = Make(TransportKind::kUdp);
  far_->Answer({.session = 5}, protocol::Welcome{.server = "furrowd", .token = 0});
  (void)subscriber.Next(0, milliseconds(0));
  const std::uint32_t request = subscriber.Subscribe(protocol::SubscribeWeights{});
  (void)far_->TakeKinds();
  (void)subscriber.Next(250'000, milliseconds(0));
  EXPECT_EQ(far_->TakeKinds(), std::vector{MessageKind::kSubscribeWeights});

  far_->Answer({.session = 5, .stream = 3, .sequence = request},
               protocol::SubscribeReply{.subject = "ada"});
  const Event event = subscriber.Next(260'000, milliseconds(0));
  EXPECT_EQ(event.kind, Kind::kReply);
  EXPECT_EQ(event.header.stream, 3);
  (void)subscriber.Next(700'000, milliseconds(0));
  EXPECT_TRUE(far_->sent.empty()) << "the request is answered";
  far_->Answer({.session = 5}, protocol::Ping{77});
  (void)subscriber.Next(800'000, milliseconds(0));
  EXPECT_EQ(far_->TakeKinds(), std::vector{MessageKind::kPong});
  (void)subscriber.Next(2'500'000, milliseconds(0));
  EXPECT_EQ(far_->TakeKinds(), std::vector{MessageKind::kPing});
  // Without challenges, the subscription may have ended while the network was away.
  (void)subscriber.Next(800'000 + protocol::kUdpLeaseMicroseconds / 2 + 1, milliseconds(0));
  EXPECT_EQ(far_->TakeKinds(), std::vector{MessageKind::kSubscribeWeights});
}

TEST_F(SubscriberTest, PosesArriveUnchangedWithTheirSkeleton) {
  Subscriber subscriber = Make(TransportKind::kUdp);
  far_->Answer({.session = 5}, protocol::Welcome{.server = "furrowd", .token = 0});
  (void)subscriber.Next(0, milliseconds(0));
  const std::uint32_t request = subscriber.Subscribe(protocol::SubscribePoses{.subject = "ada"});
  (void)far_->TakeKinds();
  protocol::SkeletonOffer offer;
  offer.subject = "ada";
  offer.blend_shape_names = {"jaw"};
  protocol::PoseFrame pose;
  pose.skeleton_hash = protocol::SkeletonHash(offer);
  pose.num_blend_shapes = 1;
  pose.blend_shapes = {0.5f};

  // The skeleton was lost: its poses are delivered, and the skeleton is requested again.
  far_->Answer({.session = 5, .stream = 3, .sequence = request},
               protocol::SubscribeReply{.subject = "ada", .publisher_session = 9});
  far_->Answer({.session = 5, .stream = 3, .sequence = 40}, pose);
  EXPECT_EQ(subscriber.Next(10, milliseconds(0)).kind, Kind::kReply);
  EXPECT_EQ(subscriber.reply().publisher_session, 9u);
  const Event event = subscriber.Next(20, milliseconds(0));
  EXPECT_EQ(event.kind, Kind::kPose);
  EXPECT_EQ(event.header.sequence, 40u);
  EXPECT_EQ(subscriber.pose().blend_shapes, pose.blend_shapes);
  std::vector<std::uint8_t> sent;
  protocol::Encoder().Encode({.session = 1}, pose, sent);
  EXPECT_TRUE(
      std::ranges::equal(subscriber.payload(), std::span(sent).subspan(protocol::kEnvelopeBytes)));
  (void)subscriber.Next(250'000, milliseconds(0));
  EXPECT_EQ(far_->TakeKinds(), std::vector{MessageKind::kSubscribePoses});

  far_->Answer({.session = 5, .stream = 3, .sequence = request},
               protocol::SubscribeReply{.subject = "ada", .publisher_session = 9});
  far_->Answer({.session = 5, .stream = 3, .sequence = request}, offer);
  far_->Answer({.session = 5, .stream = 3, .sequence = 41}, pose);
  far_->Answer({.session = 5, .stream = 3, .sequence = request}, protocol::Dropped{7});
  EXPECT_EQ(subscriber.Next(260'000, milliseconds(0)).kind, Kind::kReply);
  EXPECT_EQ(subscriber.Next(260'001, milliseconds(0)).kind, Kind::kSkeleton);
  EXPECT_EQ(subscriber.skeleton().blend_shape_names, offer.blend_shape_names);
  EXPECT_EQ(subscriber.Next(260'002, milliseconds(0)).kind, Kind::kPose);
  EXPECT_EQ(subscriber.Next(260'003, milliseconds(0)).kind, Kind::kDropped);
  EXPECT_EQ(subscriber.dropped().frames, 7u);
  (void)subscriber.Next(600'000, milliseconds(0));
  EXPECT_TRUE(far_->sent.empty()) << "nothing is missing";
}

TEST_F(SubscriberTest, LostNamesAreRequestedAgain) {
  Subscriber subscriber = Make(TransportKind::kUdp);
  far_->Answer({.session = 5}, protocol::Welcome{.server = "furrowd", .token = 0});
  (void)subscriber.Next(0, milliseconds(0));
  const std::uint32_t request = subscriber.Subscribe(protocol::SubscribeWeights{.wait = true});
  far_->Answer({.session = 5, .stream = 3, .sequence = request}, protocol::SubscribeReply{});
  EXPECT_EQ(subscriber.Next(10, milliseconds(0)).kind, Kind::kReply);
  (void)far_->TakeKinds();

  // The subject connected, but the reply with its names was lost.
  const std::vector<std::string> names{"a.x"};
  protocol::WeightFrame weights;
  weights.names_hash = protocol::NamesHash(names);
  weights.values = {0.5f};
  far_->Answer({.session = 5, .stream = 3}, weights);
  EXPECT_EQ(subscriber.Next(300'000, milliseconds(0)).kind, Kind::kWeights);
  (void)subscriber.Next(600'000, milliseconds(0));
  EXPECT_EQ(far_->TakeKinds(), (std::vector{MessageKind::kSubscribeWeights}));

  far_->Answer({.session = 5, .stream = 3, .sequence = request},
               protocol::SubscribeReply{.subject = "ada", .names = names});
  EXPECT_EQ(subscriber.Next(610'000, milliseconds(0)).kind, Kind::kReply);
  far_->Answer({.session = 5, .stream = 3}, weights);
  EXPECT_EQ(subscriber.Next(620'000, milliseconds(0)).kind, Kind::kWeights);
  (void)subscriber.Next(900'000, milliseconds(0));
  EXPECT_TRUE(far_->sent.empty());
}

TEST_F(SubscriberTest, AfterARestartOverUdpAllRequestsAreRepeated) {
  Subscriber subscriber = Make(TransportKind::kUdp);
  far_->Answer({.session = 5}, protocol::Welcome{.server = "furrowd", .token = 0});
  (void)subscriber.Next(0, milliseconds(0));
  const std::uint32_t request = subscriber.Subscribe(protocol::SubscribeWeights{});
  far_->Answer({.session = 5, .stream = 3, .sequence = request}, protocol::SubscribeReply{});
  EXPECT_EQ(subscriber.Next(10, milliseconds(0)).kind, Kind::kReply);
  (void)far_->TakeKinds();

  far_->Answer({.session = 6}, protocol::Pong{});
  EXPECT_EQ(subscriber.Next(20, milliseconds(0)).kind, Kind::kTimeout);
  EXPECT_EQ(far_->TakeKinds(), std::vector{MessageKind::kHello});
  far_->Answer({.session = 6}, protocol::Welcome{.server = "furrowd", .token = 0});
  EXPECT_EQ(subscriber.Next(30, milliseconds(0)).kind, Kind::kTimeout);
  EXPECT_EQ(far_->TakeKinds(), std::vector{MessageKind::kSubscribeWeights});

  // The daemon forgot only the address: all requests are repeated, without an error for the caller.
  far_->Answer({.session = 6, .sequence = request},
               protocol::ErrorMessage{.code = protocol::ErrorCode::kUnprovenAddress});
  EXPECT_EQ(subscriber.Next(40, milliseconds(0)).kind, Kind::kTimeout);
  EXPECT_EQ(far_->TakeKinds(), std::vector{MessageKind::kHello});
}

TEST_F(SubscriberTest, WeightsPicturesErrorsAndGoodbyesReachTheCaller) {
  Subscriber subscriber = Make(TransportKind::kTcp);
  const std::vector<std::string> names{"a.x", "b.x"};
  protocol::WeightFrame weights;
  weights.names_hash = protocol::NamesHash(names);
  weights.values = {0.25f, 1.0f};
  far_->Answer({.session = 5, .stream = 1, .sequence = 42, .capture_time_us = 77}, weights);
  far_->Answer({.session = 5, .stream = 2},
               protocol::ImageFrame{.width = 16, .height = 16, .bytes = {1, 2, 3}});
  far_->Answer({.session = 5}, protocol::ErrorMessage{.message = "no such subject"});
  far_->Answer({.session = 5}, protocol::Goodbye{.reason = protocol::GoodbyeReason::kDraining});

  const Event event = subscriber.Next(0, milliseconds(0));
  EXPECT_EQ(event.kind, Kind::kWeights);
  EXPECT_EQ(event.header.sequence, 42u);
  EXPECT_EQ(event.header.capture_time_us, 77);
  EXPECT_EQ(subscriber.weights().values, (std::vector<float>{0.25f, 1.0f}));
  EXPECT_EQ(subscriber.Next(0, milliseconds(0)).kind, Kind::kPicture);
  EXPECT_EQ(subscriber.picture().bytes.size(), 3u);
  EXPECT_EQ(subscriber.Next(0, milliseconds(0)).kind, Kind::kError);
  EXPECT_EQ(subscriber.error().message, "no such subject");
  EXPECT_EQ(subscriber.Next(0, milliseconds(0)).kind, Kind::kGoodbye);
  EXPECT_EQ(subscriber.Next(0, milliseconds(0)).kind, Kind::kTimeout);
}

TEST_F(SubscriberTest, AnErrorWithoutATextHasTheSentenceOfItsCode) {
  Subscriber subscriber = Make(TransportKind::kUdp);
  far_->Answer({.session = 5}, protocol::ErrorMessage{protocol::ErrorCode::kNeedsToken, ""});
  EXPECT_EQ(subscriber.Next(0, milliseconds(0)).kind, Kind::kError);
  EXPECT_EQ(subscriber.error().message, "the daemon requires a token");
}

TEST_F(SubscriberTest, GarbageIsCountedAndSkipped) {
  Subscriber subscriber = Make(TransportKind::kTcp);
  far_->to_receive.push_back({});
  far_->to_receive.push_back(std::vector<std::uint8_t>(100, 0xAB));
  far_->Answer({.session = 5}, protocol::Goodbye{});
  EXPECT_EQ(subscriber.Next(0, milliseconds(0)).kind, Kind::kGoodbye);
  EXPECT_EQ(subscriber.malformed(), 2u);
}

TEST_F(SubscriberTest, UnansweredPingsReportALostNetwork) {
  constexpr std::int64_t kSecond = 1'000'000;
  Subscriber subscriber = Make(TransportKind::kTcp);
  (void)far_->TakeKinds();
  EXPECT_EQ(subscriber.Next(0, milliseconds(0)).kind, Kind::kTimeout);
  // A caller that paused for an hour sent no pings, so the missing answers mean nothing.
  std::int64_t now = 3600 * kSecond;
  EXPECT_EQ(subscriber.Next(now, milliseconds(0)).kind, Kind::kTimeout);
  EXPECT_EQ(far_->TakeKinds(), std::vector{MessageKind::kPing});
  // An answer proves that the connection is alive, even without weights.
  far_->Answer({.session = 5}, protocol::Pong{});
  now += 14 * kSecond;
  EXPECT_EQ(subscriber.Next(now, milliseconds(0)).kind, Kind::kTimeout);
  // That call sent a ping and received its answer. Later pings are not answered.
  now += 2 * kSecond;
  EXPECT_EQ(subscriber.Next(now, milliseconds(0)).kind, Kind::kTimeout);
  EXPECT_EQ(subscriber.Next(now + 15 * kSecond, milliseconds(0)).kind, Kind::kTimeout);
  EXPECT_EQ(subscriber.Next(now + 15 * kSecond + 1, milliseconds(0)).kind, Kind::kClosed);
}

TEST_F(SubscriberTest, TheEndOfTheTransportIsAnEvent) {
  Subscriber subscriber = Make(TransportKind::kTcp);
  far_->when_empty = IoStatus::kClosed;
  EXPECT_EQ(subscriber.Next(0, milliseconds(0)).kind, Kind::kClosed);
  far_->when_empty = IoStatus::kNoConnection;
  EXPECT_EQ(subscriber.Next(0, milliseconds(0)).kind, Kind::kNoConnection);
}

TEST_F(SubscriberTest, GoesToTheServerThatTheDaemonNames) {
  far_->follows = far_->reconnects = true;
  Subscriber subscriber = Make(TransportKind::kTcp);
  const std::uint32_t number = subscriber.Subscribe(protocol::SubscribeWeights{.subject = "ada"});
  const protocol::ErrorMessage moved{protocol::ErrorCode::kUnknownSubject, "at b", "host-b", 7, 8};
  far_->Answer({.session = 5, .sequence = number}, moved);
  EXPECT_EQ(subscriber.Next(0, milliseconds(0)).kind, Kind::kTimeout);
  EXPECT_EQ(far_->moves, (std::vector<Elsewhere>{{"host-b", 7, 8}}));
  (void)far_->TakeKinds();
  far_->generation = 2;
  (void)subscriber.Next(1, milliseconds(0));
  EXPECT_EQ(far_->TakeKinds(), (std::vector{MessageKind::kHello, MessageKind::kSubscribeWeights}));
  // With a second subject, it does not know where to go.
  subscriber.Subscribe(protocol::SubscribeWeights{.subject = "bob"});
  far_->Answer({.session = 5, .sequence = number}, moved);
  EXPECT_EQ(subscriber.Next(2, milliseconds(0)).kind, Kind::kError);
  EXPECT_EQ(subscriber.error().host, "host-b");
  EXPECT_EQ(far_->moves.size(), 1u);
}

TEST_F(SubscriberTest, FramesOfALowerEpochAreDropped) {
  Subscriber subscriber = Make(TransportKind::kTcp);
  const std::uint32_t number = subscriber.Subscribe(protocol::SubscribeWeights{.subject = "ada"});
  const protocol::Header header{.session = 5, .stream = 3, .sequence = number};
  protocol::WeightFrame frame;
  frame.names_hash = protocol::NamesHash(std::vector<std::string>{"a"});
  frame.values = {0.5f};
  const auto next = [&](std::uint64_t epoch) {
    far_->Answer(header, protocol::SubscribeReply{"ada", 0, {"a"}, 0, epoch});
    far_->Answer({.session = 5, .stream = 3}, frame);
    const Kind first = subscriber.Next(0, milliseconds(0)).kind;
    return std::pair(first, subscriber.Next(0, milliseconds(0)).kind);
  };
  EXPECT_EQ(next(10), std::pair(Kind::kReply, Kind::kWeights));
  EXPECT_EQ(next(9), std::pair(Kind::kTimeout, Kind::kTimeout));
  EXPECT_EQ(next(11), std::pair(Kind::kReply, Kind::kWeights));
  EXPECT_EQ(next(0), std::pair(Kind::kReply, Kind::kWeights)) << "a daemon without a cluster";
}

TEST_F(SubscriberTest, EpochsOfDifferentSubjectsDoNotCompare) {
  Subscriber subscriber = Make(TransportKind::kTcp);
  const std::uint32_t number = subscriber.Subscribe(protocol::SubscribeWeights{.wait = true});
  const auto next = [&](const char* subject, std::uint64_t epoch) {
    far_->Answer({.session = 5, .stream = 3, .sequence = number},
                 protocol::SubscribeReply{subject, 0, {"a"}, 0, epoch});
    return subscriber.Next(0, milliseconds(0)).kind;
  };
  EXPECT_EQ(next("ada", 10), Kind::kReply);
  EXPECT_EQ(next("", 0), Kind::kReply) << "ada has left";
  EXPECT_EQ(next("ada", 9), Kind::kTimeout);
  EXPECT_EQ(next("bob", 4), Kind::kReply);
  EXPECT_EQ(next("bob", 3), Kind::kTimeout);
}

TEST_F(SubscriberTest, FollowsOnlyAnswersToItsOwnRequests) {
  far_->follows = far_->reconnects = true;
  Subscriber subscriber = Make(TransportKind::kTcp);
  const std::uint32_t number = subscriber.Subscribe(protocol::SubscribeWeights{.subject = "ada"});
  protocol::ErrorMessage moved{protocol::ErrorCode::kUnknownSubject, "at b", "host-b", 7, 8};
  far_->Answer({.session = 5, .sequence = number + 1}, moved);
  (void)subscriber.Next(0, milliseconds(0));
  EXPECT_TRUE(far_->moves.empty());
  moved.code = protocol::ErrorCode::kMalformed;
  far_->Answer({.session = 5, .sequence = number}, moved);
  (void)subscriber.Next(0, milliseconds(0));
  EXPECT_TRUE(far_->moves.empty());
}

}  // namespace
}  // namespace furrow::client

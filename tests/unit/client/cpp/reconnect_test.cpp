// SPDX-License-Identifier: Apache-2.0
// Subscriber and Publisher over a transport that reconnects.
#include <algorithm>

#include <gtest/gtest.h>

#include "client/cpp/publisher.h"
#include "client/cpp/subscriber.h"
#include "fake_transport.h"
#include "protocol/messages/hash.h"
#include "protocol/messages/limits.h"

namespace furrow::client {
namespace {

using protocol::MessageKind;
using std::chrono::milliseconds;
using Kind = Event::Kind;

class ReconnectTest : public testing::Test {
 protected:
  ReconnectTest() { far_->reconnects = true; }

  std::unique_ptr<Transport> Make(TransportKind kind) {
    return std::make_unique<FakeTransport>(kind, far_);
  }
  // Subscribes, and answers as the daemon with session 5 and subscription 3. Returns the request.
  std::uint32_t Subscribe(Subscriber& subscriber) {
    const std::uint32_t request = subscriber.Subscribe(protocol::SubscribeWeights{});
    far_->Answer({.session = 5}, protocol::Welcome{});
    far_->Answer({.session = 5, .stream = 3, .sequence = request}, protocol::SubscribeReply{});
    return request;
  }
  // Reads all messages that wait, and returns the kinds of the events.
  std::vector<Kind> Drain(Subscriber& subscriber) {
    std::vector<Kind> kinds;
    for (;;) {
      const Kind kind = subscriber.Next(now_us_, milliseconds(0)).kind;
      if (kind == Kind::kTimeout) return kinds;
      kinds.push_back(kind);
    }
  }
  // The decoded message of one kind that was sent since the last TakeKinds().
  template <class Message>
  Message Sent(MessageKind kind) {
    Message message;
    for (const auto& bytes : far_->sent) {
      protocol::MessageView view;
      EXPECT_EQ(protocol::OpenMessage(bytes, view), protocol::DecodeStatus::kOk);
      if (view.kind != kind) continue;
      EXPECT_EQ(protocol::Decode(view, message), protocol::DecodeStatus::kOk);
      return message;
    }
    ADD_FAILURE() << "not sent";
    return message;
  }

  std::shared_ptr<FarEnd> far_ = std::make_shared<FarEnd>();
  std::int64_t now_us_ = 0;
};

TEST_F(ReconnectTest, OverTcpEveryRequestIsRepeatedOnTheNextConnection) {
  Subscriber subscriber(Make(TransportKind::kTcp), "test");
  const std::uint32_t request = subscriber.Subscribe(protocol::SubscribeWeights{.subject = "ada"});
  (void)subscriber.ListSubjects(true);
  far_->Answer({.session = 5}, protocol::Welcome{.server = "furrowd"});
  far_->Answer({.session = 5, .stream = 3, .sequence = request},
               protocol::SubscribeReply{.subject = "ada"});
  EXPECT_EQ(Drain(subscriber), (std::vector{Kind::kConnected, Kind::kReply}));
  (void)far_->TakeKinds();

  far_->when_empty = IoStatus::kNoConnection;
  EXPECT_EQ(subscriber.Next(++now_us_, milliseconds(0)).kind, Kind::kNoConnection);
  far_->when_empty = IoStatus::kTimeout;
  far_->generation = 2;
  EXPECT_EQ(subscriber.Next(++now_us_, milliseconds(0)).kind, Kind::kTimeout);
  // The subject may come back after this client, so its subscription must wait.
  EXPECT_TRUE(Sent<protocol::SubscribeWeights>(MessageKind::kSubscribeWeights).wait);
  EXPECT_EQ(far_->TakeKinds(), (std::vector{MessageKind::kHello, MessageKind::kSubscribeWeights,
                                            MessageKind::kListSubjects}));
  far_->Answer({.session = 6}, protocol::Welcome{.server = "furrowd"});
  far_->Answer({.session = 6, .stream = 1, .sequence = request},
               protocol::SubscribeReply{.subject = "ada"});
  EXPECT_EQ(Drain(subscriber), (std::vector{Kind::kConnected, Kind::kReply}));
}

TEST_F(ReconnectTest, OverUdpAClosedPortLeadsToAnotherProof) {
  Subscriber subscriber(Make(TransportKind::kUdp), "test");
  const std::uint32_t request = subscriber.Subscribe(protocol::SubscribeWeights{});
  far_->Answer({.session = 5}, protocol::Welcome{.server = "furrowd"});
  far_->Answer({.session = 5, .stream = 3, .sequence = request},
               protocol::SubscribeReply{.subject = "ada"});
  EXPECT_EQ(Drain(subscriber), (std::vector{Kind::kConnected, Kind::kReply}));
  (void)far_->TakeKinds();

  far_->when_empty = IoStatus::kNoConnection;
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(subscriber.Next(now_us_ += 100'000, milliseconds(0)).kind, Kind::kNoConnection);
  }
  const auto kinds = far_->TakeKinds();
  EXPECT_EQ(std::ranges::count(kinds, MessageKind::kHello), static_cast<long>(kinds.size()));
  EXPECT_GE(kinds.size(), 4u) << "so that the client is back soon after the daemon";
  EXPECT_LE(kinds.size(), 5u);

  far_->when_empty = IoStatus::kTimeout;
  far_->Answer({.session = 6}, protocol::Welcome{.server = "furrowd", .token = 9});
  far_->Answer({.session = 6}, protocol::Welcome{.server = "furrowd"});
  EXPECT_EQ(Drain(subscriber), std::vector{Kind::kConnected});
  EXPECT_EQ(far_->TakeKinds(), (std::vector{MessageKind::kHello, MessageKind::kSubscribeWeights}));
}

TEST_F(ReconnectTest, AClientThatTheDaemonForgotAsksAgain) {
  Subscriber subscriber(Make(TransportKind::kTcp), "test");
  const std::uint32_t request = Subscribe(subscriber);
  far_->Answer({.session = 5}, protocol::Goodbye{protocol::GoodbyeReason::kDraining});
  far_->Answer({.session = 5, .sequence = request},
               protocol::ErrorMessage{protocol::ErrorCode::kDraining, "shutting down"});
  EXPECT_EQ(Drain(subscriber), (std::vector{Kind::kConnected, Kind::kReply, Kind::kGoodbye}));
  (void)far_->TakeKinds();
  far_->generation = 2;
  (void)subscriber.Next(1, milliseconds(0));
  EXPECT_EQ(far_->TakeKinds(), (std::vector{MessageKind::kHello, MessageKind::kSubscribeWeights}));
}

TEST_F(ReconnectTest, AProgramThatSleptLongerThanItsLeaseAsksAgain) {
  Subscriber subscriber(Make(TransportKind::kUdp), "test");
  (void)Subscribe(subscriber);
  EXPECT_EQ(Drain(subscriber), (std::vector{Kind::kConnected, Kind::kReply}));
  (void)far_->TakeKinds();
  now_us_ += protocol::kUdpLeaseMicroseconds + 1;
  far_->Answer({.session = 5}, protocol::Welcome{});
  EXPECT_EQ(Drain(subscriber), std::vector{Kind::kConnected});
  EXPECT_EQ(far_->TakeKinds(), (std::vector{MessageKind::kHello, MessageKind::kSubscribeWeights}));
}

TEST_F(ReconnectTest, ASilentTcpPeerIsAbandoned) {
  Subscriber subscriber(Make(TransportKind::kTcp), "test");
  std::vector<Kind> kinds;
  for (now_us_ = 0; now_us_ < 20'000'000 && !far_->abandoned; now_us_ += 1'000'000) {
    kinds.push_back(subscriber.Next(now_us_, milliseconds(0)).kind);
  }
  EXPECT_TRUE(far_->abandoned);
  EXPECT_EQ(kinds.back(), Kind::kNoConnection);
  EXPECT_EQ(std::ranges::count(kinds, Kind::kNoConnection), 1);
}

TEST_F(ReconnectTest, ACancelledRequestIsNotRepeated) {
  Subscriber subscriber(Make(TransportKind::kTcp), "test");
  const std::uint32_t answered = subscriber.Subscribe(protocol::SubscribeWeights{.subject = "a"});
  const std::uint32_t waiting = subscriber.Subscribe(protocol::SubscribeWeights{.subject = "b"});
  far_->Answer({.session = 5, .stream = 3, .sequence = answered}, protocol::SubscribeReply{});
  (void)Drain(subscriber);
  (void)far_->TakeKinds();
  subscriber.Cancel(answered);
  subscriber.Cancel(waiting);
  EXPECT_EQ(far_->TakeKinds(), std::vector{MessageKind::kUnsubscribe});
  far_->generation = 2;
  (void)Drain(subscriber);
  EXPECT_EQ(far_->TakeKinds(), std::vector{MessageKind::kHello});
}

TEST_F(ReconnectTest, APublisherOffersItsSubjectsOnEveryConnection) {
  Publisher publisher(Make(TransportKind::kTcp));
  protocol::SkeletonOffer offer;
  offer.subject = "ada";
  offer.joints = {{.name = "root"}};
  const std::uint16_t stream = publisher.AddSubject(offer, 0);
  offer.subject = "bob";
  const std::uint16_t withdrawn = publisher.AddSubject(offer, 0);
  far_->Answer({.session = 7, .stream = stream},
               protocol::SkeletonReply{.skeleton_hash = protocol::SkeletonHash(offer)});
  (void)publisher.Poll(0, milliseconds(0));
  ASSERT_TRUE(publisher.accepted(stream));
  publisher.Withdraw(withdrawn, "done");
  (void)far_->TakeKinds();

  far_->generation = 2;
  (void)publisher.Poll(1, milliseconds(0));
  EXPECT_FALSE(publisher.accepted(stream));
  EXPECT_EQ(far_->TakeKinds(), std::vector{MessageKind::kSkeletonOffer}) << "only of ada";
  EXPECT_EQ(publisher.rejection(withdrawn), "done");
}

}  // namespace
}  // namespace furrow::client

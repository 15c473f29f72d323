// SPDX-License-Identifier: Apache-2.0
#include "client/cpp/reconnecting_transport.h"

#include <deque>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "client/cpp/tls/client_tls.h"
#include "fake_transport.h"

namespace furrow::client {
namespace {

using std::chrono::milliseconds;

TEST(Backoff, PausesGrowToTheLimitAndStayBetweenHalfAndWhole) {
  Backoff backoff(7, {.first_us = 1000, .most_us = 8000});
  EXPECT_LE(backoff.Wait(-5), 0) << "the first attempt is due at once";
  std::int64_t now = 0;
  for (const std::int64_t pause : {1000, 2000, 4000, 8000, 8000}) {
    backoff.Failed(now);
    EXPECT_GE(backoff.Wait(now), pause / 2);
    EXPECT_LE(backoff.Wait(now), pause);
    now += backoff.Wait(now);
    EXPECT_EQ(backoff.Wait(now), 0);
  }
  backoff.Succeeded();
  backoff.Failed(now);
  EXPECT_LE(backoff.Wait(now), 1000);
}

TEST(Backoff, ClientsDoNotComeBackTogether) {
  Backoff one(1, {});
  Backoff other(2, {});
  one.Failed(0);
  other.Failed(0);
  EXPECT_NE(one.Wait(0), other.Wait(0));
}

// Attempts of a transport, planned by the test.
class ReconnectingTransportTest : public testing::Test {
 protected:
  ReconnectingTransport Make(TransportKind kind) {
    const auto open = [this, kind]() -> Result<std::unique_ptr<Transport>> {
      ++attempts_;
      if (!reachable_) return Status(StatusCode::kUnavailable, "connection refused");
      far_ = std::make_shared<FarEnd>();
      return std::unique_ptr<Transport>(std::make_unique<FakeTransport>(kind, far_));
    };
    return {kind, open, [this] { return now_us_; },
            Backoff(3, {.first_us = 1000, .most_us = 4000})};
  }
  IoStatus Receive(Transport& transport) {
    std::span<const std::uint8_t> message;
    return transport.Receive(message, milliseconds(0));
  }
  // A transport with a connection that was open. The next Receive() notices its loss, and the one
  // after the pause opens the second connection.
  void ExpectOpensAgain(Transport& transport) {
    EXPECT_EQ(Receive(transport), IoStatus::kNoConnection);
    EXPECT_FALSE(transport.connected());
    now_us_ += 4000;
    EXPECT_EQ(Receive(transport), IoStatus::kTimeout);
    EXPECT_EQ(transport.generation(), 2u);
  }

  bool reachable_ = true;
  int attempts_ = 0;
  std::int64_t now_us_ = 0;
  std::shared_ptr<FarEnd> far_;
  const std::vector<std::uint8_t> bytes_ = {1, 2, 3};
};

TEST_F(ReconnectingTransportTest, OpensOnTheFirstReceive) {
  ReconnectingTransport transport = Make(TransportKind::kTcp);
  EXPECT_FALSE(transport.connected());
  EXPECT_EQ(transport.generation(), 0u);
  EXPECT_EQ(transport.Send(bytes_), IoStatus::kNoConnection);
  EXPECT_EQ(Receive(transport), IoStatus::kTimeout);
  EXPECT_TRUE(transport.connected());
  EXPECT_EQ(transport.generation(), 1u);
  EXPECT_EQ(transport.Send(bytes_), IoStatus::kOk);
}

TEST_F(ReconnectingTransportTest, AFailedAttemptIsRepeatedAfterItsPause) {
  reachable_ = false;
  ReconnectingTransport transport = Make(TransportKind::kTcp);
  EXPECT_EQ(Receive(transport), IoStatus::kNoConnection);
  EXPECT_EQ(transport.failure(), "connection refused");
  EXPECT_EQ(Receive(transport), IoStatus::kNoConnection);
  EXPECT_EQ(attempts_, 1) << "the pause has not passed";
  reachable_ = true;
  now_us_ += 1000;
  EXPECT_EQ(Receive(transport), IoStatus::kTimeout);
  EXPECT_EQ(attempts_, 2);
  EXPECT_TRUE(transport.connected());
}

TEST_F(ReconnectingTransportTest, AnAttemptThatBlockedIsRepeatedMuchLater) {
  std::int64_t now_us = 0;
  int attempts = 0;
  const auto open = [&]() -> Result<std::unique_ptr<Transport>> {
    ++attempts;
    now_us += 1'000'000;  // the resolver waits for a network
    return Status(StatusCode::kUnavailable, "host not found");
  };
  ReconnectingTransport transport(
      TransportKind::kUdp, open, [&] { return now_us; }, Backoff(3, {}));
  for (int i = 0; i < 100; ++i, now_us += 100'000) (void)Receive(transport);
  EXPECT_GE(attempts, 2);
  EXPECT_LE(attempts, 3) << "a fifth of the time at most";
}

// A connection whose handshake does not end.
class ShakingTransport : public Transport {
 public:
  ShakingTransport() : Transport(TransportKind::kTcp) {}
  IoStatus Send(std::span<const std::uint8_t>) override { return IoStatus::kNoConnection; }
  IoStatus Receive(std::span<const std::uint8_t>&, std::chrono::milliseconds) override {
    return IoStatus::kTimeout;
  }
  [[nodiscard]] bool connected() const override { return false; }
  [[nodiscard]] std::chrono::microseconds connect_timeout() const override {
    return std::chrono::seconds(7);
  }
};

TEST_F(ReconnectingTransportTest, AnAttemptHasTheTimeThatItNeeds) {
  std::int64_t now_us = 0;
  ReconnectingTransport transport(
      TransportKind::kTcp,
      [] { return Result<std::unique_ptr<Transport>>(std::make_unique<ShakingTransport>()); },
      [&] { return now_us; }, Backoff(3, {}));
  EXPECT_EQ(Receive(transport), IoStatus::kTimeout);
  now_us += 7'000'000;
  EXPECT_EQ(Receive(transport), IoStatus::kTimeout);
  now_us += 1;
  EXPECT_EQ(Receive(transport), IoStatus::kNoConnection);
}

TEST_F(ReconnectingTransportTest, AClosedTcpConnectionIsOpenedAgain) {
  ReconnectingTransport transport = Make(TransportKind::kTcp);
  EXPECT_EQ(Receive(transport), IoStatus::kTimeout);
  far_->when_empty = IoStatus::kClosed;
  ExpectOpensAgain(transport);
}

TEST_F(ReconnectingTransportTest, AFailedSendOpensAgainToo) {
  ReconnectingTransport transport = Make(TransportKind::kTcp);
  EXPECT_EQ(Receive(transport), IoStatus::kTimeout);
  far_->when_sent = IoStatus::kClosed;
  EXPECT_EQ(transport.Send(bytes_), IoStatus::kNoConnection);
  ExpectOpensAgain(transport);
}

TEST_F(ReconnectingTransportTest, APortThatClosesEveryConnectionIsTriedLessOften) {
  ReconnectingTransport transport = Make(TransportKind::kTcp);
  for (std::int64_t end = now_us_ + 100'000; now_us_ < end; now_us_ += 100) {
    (void)Receive(transport);
    if (far_ != nullptr) far_->when_empty = IoStatus::kClosed;
  }
  // The longest pause is 4 ms, and the shortest of those 2 ms.
  EXPECT_LE(attempts_, 54);
  EXPECT_GE(attempts_, 20);
}

TEST_F(ReconnectingTransportTest, ADaemonThatRefusesEveryConnectionIsTriedLessOften) {
  ReconnectingTransport transport = Make(TransportKind::kTcp);
  for (std::int64_t end = now_us_ + 100'000; now_us_ < end; now_us_ += 100) {
    const int before = attempts_;
    (void)Receive(transport);
    // One error, then the end.
    if (attempts_ != before) far_->to_receive.push_back(bytes_);
    if (far_ != nullptr) far_->when_empty = IoStatus::kClosed;
  }
  EXPECT_LE(attempts_, 54);
  EXPECT_GE(attempts_, 20);
}

TEST_F(ReconnectingTransportTest, AConnectionThatWorkedIsOpenedAgainSoon) {
  ReconnectingTransport transport = Make(TransportKind::kTcp);
  reachable_ = false;
  for (int i = 0; i < 10; ++i, now_us_ += 4000) (void)Receive(transport);
  reachable_ = true;
  EXPECT_EQ(Receive(transport), IoStatus::kTimeout);
  now_us_ += 1'000'000;
  far_->to_receive.push_back(bytes_);
  EXPECT_EQ(Receive(transport), IoStatus::kOk);
  far_->when_empty = IoStatus::kClosed;
  EXPECT_EQ(Receive(transport), IoStatus::kNoConnection);
  now_us_ += 1000;
  EXPECT_EQ(Receive(transport), IoStatus::kTimeout) << "the first pause is the short one again";
}

TEST_F(ReconnectingTransportTest, AUdpSocketIsKeptForSomeSeconds) {
  ReconnectingTransport transport = Make(TransportKind::kUdp);
  EXPECT_EQ(Receive(transport), IoStatus::kTimeout);
  far_->when_empty = IoStatus::kNoConnection;
  EXPECT_EQ(Receive(transport), IoStatus::kNoConnection);
  now_us_ += 4'900'000;
  EXPECT_EQ(Receive(transport), IoStatus::kNoConnection);
  EXPECT_EQ(transport.generation(), 1u);
  now_us_ += 200'000;
  EXPECT_EQ(Receive(transport), IoStatus::kNoConnection);
  now_us_ += 10'000;
  EXPECT_EQ(Receive(transport), IoStatus::kTimeout);
  EXPECT_EQ(transport.generation(), 2u) << "the network may have changed";
}

TEST_F(ReconnectingTransportTest, AnAbandonedConnectionIsOpenedAgain) {
  ReconnectingTransport transport = Make(TransportKind::kTcp);
  EXPECT_EQ(Receive(transport), IoStatus::kTimeout);
  transport.Abandon();
  EXPECT_EQ(transport.Send(bytes_), IoStatus::kNoConnection);
  ExpectOpensAgain(transport);
}

TEST_F(ReconnectingTransportTest, MessagesThatNeverFitAreRefusedWithoutAConnection) {
  ReconnectingTransport transport = Make(TransportKind::kUdp);
  EXPECT_EQ(transport.Send(std::vector<std::uint8_t>(200'000)), IoStatus::kTooLarge);
}

// A transport that may go to other servers; `visited_` lists their hosts.
class FollowingTransportTest : public ReconnectingTransportTest {
 protected:
  FollowingTransportTest() : transport_(Make(TransportKind::kTcp)) {
    transport_.FollowBy([this](const Elsewhere& server) -> Result<std::unique_ptr<Transport>> {
      visited_.push_back(server.host);
      if (!reachable_) return Status(StatusCode::kUnavailable, "connection refused");
      far_ = std::make_shared<FarEnd>();
      return std::unique_ptr<Transport>(std::make_unique<FakeTransport>(TransportKind::kTcp, far_));
    });
    EXPECT_EQ(Receive(transport_), IoStatus::kTimeout);
  }
  // Lets the pause before the next attempt pass.
  void Pass() { now_us_ += 4000; }

  ReconnectingTransport transport_;
  std::vector<std::string> visited_;
};

TEST_F(FollowingTransportTest, GoesWhereItIsSentAtOnce) {
  EXPECT_TRUE(transport_.GoTo({"b", 1, 2}));
  EXPECT_EQ(transport_.Send(bytes_), IoStatus::kNoConnection);
  EXPECT_EQ(Receive(transport_), IoStatus::kTimeout) << "without a pause";
  EXPECT_EQ(visited_, std::vector<std::string>{"b"});
  EXPECT_EQ(transport_.generation(), 2u);
  EXPECT_EQ(transport_.Send(bytes_), IoStatus::kOk);
}

TEST_F(FollowingTransportTest, ServersThatSendItToAndFroKeepItSoonEnough) {
  for (std::size_t i = 0; i < ReconnectingTransport::kMostMoves; ++i) {
    EXPECT_TRUE(transport_.GoTo({i % 2 == 0 ? "b" : "c", 1, 2}));
    EXPECT_EQ(Receive(transport_), IoStatus::kTimeout);
  }
  EXPECT_TRUE(transport_.GoTo({"b", 1, 2})) << "later";
  EXPECT_EQ(Receive(transport_), IoStatus::kTimeout);
  EXPECT_EQ(visited_.size(), ReconnectingTransport::kMostMoves);
  now_us_ += ReconnectingTransport::kMoveWindow.count() + 1;
  EXPECT_TRUE(transport_.GoTo({"b", 1, 2}));
  EXPECT_EQ(Receive(transport_), IoStatus::kTimeout);
  EXPECT_EQ(visited_.size(), ReconnectingTransport::kMostMoves + 1);
}

TEST_F(FollowingTransportTest, IsNotSentBackToAServerThatItHasJustLost) {
  EXPECT_TRUE(transport_.GoTo({"b", 1, 2}));
  EXPECT_EQ(Receive(transport_), IoStatus::kTimeout);
  transport_.Abandon();
  EXPECT_EQ(Receive(transport_), IoStatus::kNoConnection);
  Pass();
  EXPECT_EQ(Receive(transport_), IoStatus::kTimeout) << "the first server";
  EXPECT_TRUE(transport_.GoTo({"b", 1, 2}));
  EXPECT_EQ(transport_.Send(bytes_), IoStatus::kOk) << "it stays";
  now_us_ += 3'000'000;
  EXPECT_TRUE(transport_.GoTo({"b", 1, 2}));
  EXPECT_EQ(transport_.Send(bytes_), IoStatus::kNoConnection);
}

TEST_F(FollowingTransportTest, TriesTheOthersInTurnWhenTheServerIsLost) {
  transport_.Remember(std::vector<Elsewhere>{{"b", 1, 2}, {"c", 1, 2}});
  EXPECT_TRUE(transport_.has_others());
  reachable_ = false;
  transport_.Abandon();
  const int before = attempts_;
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(Receive(transport_), IoStatus::kNoConnection);
    Pass();
  }
  EXPECT_EQ(visited_, (std::vector<std::string>{"b", "c", "b", "c"}));
  EXPECT_EQ(attempts_, before + 1) << "the first server, too";
}

TEST_F(FollowingTransportTest, KeepsFewServers) {
  std::vector<Elsewhere> many;
  for (int i = 0; i < 100; ++i) many.push_back({"host-" + std::to_string(i), 1, 2});
  transport_.Remember(many);
  reachable_ = false;
  transport_.Abandon();
  for (int i = 0; i < 200; ++i, Pass()) (void)Receive(transport_);
  EXPECT_EQ(std::set<std::string>(visited_.begin(), visited_.end()).size(), 8u);
}

TEST_F(ReconnectingTransportTest, StaysWhereItIsUnlessItMayFollow) {
  ReconnectingTransport transport = Make(TransportKind::kTcp);
  EXPECT_EQ(Receive(transport), IoStatus::kTimeout);
  EXPECT_FALSE(transport.GoTo({"b", 1, 2}));
  transport.Remember(std::vector<Elsewhere>{{"b", 1, 2}});
  EXPECT_FALSE(transport.has_others());
}

// Over TCP, a token goes only to servers with a certificate of an authority that the user named.
TEST_F(ReconnectingTransportTest, ATokenOverTcpGoesNowhereElse) {
  const auto follows = [](TransportKind kind, Security security) {
    const auto transport =
        ReconnectingTransport::Create(kind, "127.0.0.1", 1, {}, nullptr, std::move(security));
    return transport->GoTo({"127.0.0.1", 1, 2});
  };
  const auto context = MakeTlsContext({});
  ASSERT_TRUE(context.ok());
  const protocol::secure::ClientToken token{};
  EXPECT_TRUE(follows(TransportKind::kTcp, {}));
  EXPECT_TRUE(follows(TransportKind::kUdp, {.token = token}));
  EXPECT_FALSE(follows(TransportKind::kTcp, {.token = token}));
  EXPECT_FALSE(follows(TransportKind::kTcp, {.token = token, .tls = *context}));
  EXPECT_TRUE(
      follows(TransportKind::kTcp, {.token = token, .tls = *context, .own_authority = true}));
  EXPECT_FALSE(
      follows(TransportKind::kTcp,
              {.token = token, .tls = *context, .own_authority = true, .token_in_clear = true}));
}

TEST(Elsewhere, IsReadFromText) {
  EXPECT_EQ(ParseElsewhere("10.0.0.2:7400:7401"), (Elsewhere{"10.0.0.2", 7400, 7401}));
  EXPECT_EQ(ParseElsewhere("fe80::1:1:2"), (Elsewhere{"fe80::1", 1, 2}));
  for (const char* text :
       {"", "h", "h:1", ":1:2", "h:0:1", "h:1:0", "h:1:65536", "h:x:1", "h:1:"}) {
    EXPECT_FALSE(ParseElsewhere(text)) << text;
  }
}

}  // namespace
}  // namespace furrow::client

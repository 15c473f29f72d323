// SPDX-License-Identifier: Apache-2.0
#include "client/cpp/acceptance.h"

#include <gtest/gtest.h>

#include "fake_transport.h"
#include "protocol/messages/hash.h"

namespace furrow::client {
namespace {

using protocol::SkeletonStatus;

class AcceptanceTest : public ::testing::Test {
 protected:
  AcceptanceTest() {
    offer_.subject = "ada";
    offer_.joints = {{.name = "root"}};
    stream_ = publisher_.AddSubject(offer_, now_us_);
  }
  void Answer(SkeletonStatus status, const std::string& message = {}) {
    far_->Answer(
        {.session = 7, .stream = stream_},
        protocol::SkeletonReply{
            .skeleton_hash = protocol::SkeletonHash(offer_), .status = status, .message = message});
  }
  // Uses a clock that advances by `step_us` at every call.
  Acceptance Wait(std::int64_t step_us) {
    return WaitUntilAccepted(
        publisher_, stream_, [&] { return now_us_ += step_us; }, [&] { return go_on_; });
  }

  std::int64_t now_us_ = 0;
  bool go_on_ = true;
  std::shared_ptr<FarEnd> far_ = std::make_shared<FarEnd>();
  Publisher publisher_{std::make_unique<FakeTransport>(TransportKind::kUdp, far_)};
  protocol::SkeletonOffer offer_;
  std::uint16_t stream_ = 0;
};

TEST_F(AcceptanceTest, AnAnswerEndsTheWait) {
  Answer(SkeletonStatus::kAccepted);
  EXPECT_EQ(Wait(1).kind, Acceptance::Kind::kAccepted);
}

TEST_F(AcceptanceTest, ARejectionHasAReason) {
  Answer(SkeletonStatus::kRejected, "no such joint");
  const Acceptance answer = Wait(1);
  EXPECT_EQ(answer.kind, Acceptance::Kind::kRefused);
  EXPECT_EQ(answer.reason, "no such joint");
}

TEST_F(AcceptanceTest, WithoutAnAnswerTheOfferIsRepeatedForFiveSeconds) {
  EXPECT_EQ(Wait(10'000).kind, Acceptance::Kind::kNoAnswer);
  EXPECT_GE(now_us_, 5'000'000);
  EXPECT_LT(now_us_, 5'100'000);
  EXPECT_GE(far_->sent.size(), 20u) << "five per second";
}

TEST_F(AcceptanceTest, AnErrorOfTheDaemonIsReported) {
  far_->Answer({.session = 7},
               protocol::ErrorMessage{.code = protocol::ErrorCode::kLimit, .message = "full"});
  const Acceptance answer = Wait(10'000);
  EXPECT_EQ(answer.kind, Acceptance::Kind::kError);
  EXPECT_EQ(answer.reason, "full");
}

TEST_F(AcceptanceTest, AClosedPortIsDistinguishedFromATimeout) {
  far_->when_empty = IoStatus::kNoConnection;
  EXPECT_EQ(Wait(5'000'000).kind, Acceptance::Kind::kNoConnection);
  // The port is reported as closed once per offer; in between Receive() times out.
  int looks = 0;
  const auto keep_going = [&] {
    far_->when_empty = looks++ == 0 ? IoStatus::kNoConnection : IoStatus::kTimeout;
    return true;
  };
  const auto clock = [&] { return now_us_ += 1'000'000; };
  EXPECT_EQ(WaitUntilAccepted(publisher_, stream_, clock, keep_going).kind,
            Acceptance::Kind::kNoConnection);
}

TEST_F(AcceptanceTest, AClosedConnectionEndsTheWait) {
  far_->when_empty = IoStatus::kClosed;
  EXPECT_EQ(Wait(1).kind, Acceptance::Kind::kNoAnswer);
  EXPECT_LT(now_us_, 10);
}

TEST_F(AcceptanceTest, TheCallerCanCancelTheWait) {
  go_on_ = false;
  EXPECT_EQ(Wait(1).kind, Acceptance::Kind::kCancelled);
}

}  // namespace
}  // namespace furrow::client

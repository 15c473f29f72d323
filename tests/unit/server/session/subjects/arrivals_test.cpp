// SPDX-License-Identifier: Apache-2.0
#include "server/session/subjects/arrivals.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "protocol/messages/limits.h"

namespace furrow::server {
namespace {

class ArrivalsTest : public ::testing::Test {
 protected:
  bool Add(const std::string& subject, std::int64_t captured_us = 0, std::size_t extra = 0,
           std::uint32_t number = 0) {
    protocol::SubjectState state;
    state.subject = subject;
    state.publisher_session = kPublisher;
    state.captures = std::string(extra, ' ');
    protocol::Encoder().Encode({.session = 1, .sequence = number, .capture_time_us = captured_us},
                               state, bytes_);
    protocol::MessageView view;
    EXPECT_EQ(protocol::OpenMessage(bytes_, view), protocol::DecodeStatus::kOk);
    return arrivals_.Add(state, view, now_);
  }

  static constexpr std::uint64_t kPublisher = 5;
  Arrivals arrivals_;
  Time now_ = std::chrono::seconds(100);
  std::vector<std::uint8_t> bytes_;
};

TEST_F(ArrivalsTest, AStateIsTakenOnceAndTheNewestCounts) {
  ASSERT_TRUE(Add("ada", 1));
  ASSERT_TRUE(Add("ada", 2));
  EXPECT_FALSE(arrivals_.Take("bob", now_));
  const auto arrived = arrivals_.Take("ada", now_);
  ASSERT_TRUE(arrived);
  EXPECT_EQ(arrived->header.capture_time_us, 2);
  EXPECT_EQ(arrived->state.subject, "ada");
  EXPECT_FALSE(arrivals_.Take("ada", now_));
  EXPECT_EQ(arrivals_.bytes(), 0u);
}

TEST_F(ArrivalsTest, ALateCopyOfAnOlderStateChangesNothing) {
  ASSERT_TRUE(Add("ada", 2, 0, 8));
  ASSERT_TRUE(Add("ada", 1, 0, 7));
  EXPECT_EQ(arrivals_.Take("ada", now_)->header.capture_time_us, 2);
}

// The numbers of two conversations do not compare, but those of poses do.
TEST_F(ArrivalsTest, ALateCopyOfAnEarlierConversationChangesNothing) {
  const auto add = [this](std::uint64_t session, std::uint64_t publisher, std::uint32_t newest) {
    protocol::SubjectState state;
    state.subject = "ada";
    state.publisher_session = publisher;
    state.newest_sequence = newest;
    protocol::Encoder().Encode({.session = session, .sequence = 1}, state, bytes_);
    protocol::MessageView view;
    EXPECT_EQ(protocol::OpenMessage(bytes_, view), protocol::DecodeStatus::kOk);
    EXPECT_TRUE(arrivals_.Add(state, view, now_));
  };
  const auto newest = [this] { return arrivals_.Take("ada", now_)->state.newest_sequence; };
  add(2, kPublisher, 25);
  add(1, kPublisher, 3);
  EXPECT_EQ(newest(), 25u);
  add(2, kPublisher, 0xFFFFFFFF);
  add(3, kPublisher, 4);
  EXPECT_EQ(newest(), 4u) << "the numbers have wrapped around";
  add(2, kPublisher, 25);
  add(3, kPublisher + 1, 3);
  EXPECT_EQ(newest(), 3u) << "another publisher counts from anywhere";
}

TEST_F(ArrivalsTest, AStateThatDoesNotFitLeavesTheFormerOne) {
  ASSERT_TRUE(Add("ada", 1));
  while (Add("subject " + std::to_string(arrivals_.bytes()), 0, protocol::kMaxCaptureBytes)) {
  }
  EXPECT_FALSE(Add("ada", 2, protocol::kMaxCaptureBytes));
  EXPECT_EQ(arrivals_.Take("ada", now_)->header.capture_time_us, 1);
}

TEST_F(ArrivalsTest, StatesEnd) {
  ASSERT_TRUE(Add("ada"));
  ASSERT_TRUE(Add("bob"));
  now_ += Arrivals::kPatience;
  EXPECT_FALSE(arrivals_.Take("ada", now_));
  EXPECT_GT(arrivals_.bytes(), 0u);
  arrivals_.Expire(now_);
  EXPECT_EQ(arrivals_.bytes(), 0u);
}

TEST_F(ArrivalsTest, OnlyThePublisherMayComeAtFirst) {
  arrivals_.Await("ada", 1, {.session = kPublisher + 1}, 2, now_);
  arrivals_.Await("bob", 1, {.session = kPublisher}, 2, now_);
  ASSERT_TRUE(Add("ada"));
  ASSERT_TRUE(Add("bob"));
  EXPECT_FALSE(arrivals_.waiting().contains("ada"));
  EXPECT_TRUE(arrivals_.waiting().contains("bob"));
  EXPECT_TRUE(arrivals_.IsReserved("ada", kPublisher + 1, now_));
  EXPECT_FALSE(arrivals_.IsReserved("ada", kPublisher, now_));
  EXPECT_FALSE(arrivals_.IsReserved("eve", kPublisher + 1, now_));
  EXPECT_FALSE(arrivals_.IsReserved("ada", kPublisher + 1, now_ + Arrivals::kReserved));
}

TEST_F(ArrivalsTest, TheirMemoryIsBounded) {
  int added = 0;
  while (Add("subject " + std::to_string(added), 0, protocol::kMaxCaptureBytes)) ++added;
  EXPECT_GT(added, 200);
  EXPECT_LE(arrivals_.bytes(), Arrivals::kMaxBytes);
  // Another one finds room when the old ones have ended.
  now_ += Arrivals::kPatience;
  EXPECT_TRUE(Add("late"));
}

TEST_F(ArrivalsTest, WaitingPublishersAreBoundedAndEnd) {
  for (std::size_t i = 0; i < Arrivals::kMaxWaiting + 10; ++i) {
    arrivals_.Await("subject " + std::to_string(i), 1, {}, 2, now_);
  }
  EXPECT_EQ(arrivals_.waiting().size(), Arrivals::kMaxWaiting);
  arrivals_.StopWaiting("subject 0");
  EXPECT_EQ(arrivals_.waiting().size(), Arrivals::kMaxWaiting - 1);
  arrivals_.Expire(now_ + std::chrono::seconds(3));
  EXPECT_TRUE(arrivals_.waiting().empty());
}

}  // namespace
}  // namespace furrow::server

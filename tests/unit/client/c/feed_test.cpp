// SPDX-License-Identifier: Apache-2.0
#include "client/c/feed.h"

#include <limits>
#include <optional>

#include <gtest/gtest.h>

#include "protocol/messages/hash.h"

namespace furrow::capi {
namespace {

using Arrival = Feed::Arrival;

class FeedTest : public testing::Test {
 protected:
  FeedTest() { Name({"brow.a", "brow.b"}); }

  bool Name(const std::vector<std::string>& names) {
    protocol::SubscribeReply reply;
    reply.subject = "ada";
    reply.names = names;
    names_hash_ = protocol::NamesHash(names);
    return feed_.OnReply(reply, 4);
  }
  Arrival Frame(std::uint32_t sequence, std::int64_t capture_us, std::int64_t age_us = 0,
                std::vector<float> values = {0.25f, 0.5f}) {
    protocol::WeightFrame frame;
    frame.names_hash = names_hash_;
    frame.age_us = age_us;
    frame.values = std::move(values);
    return feed_.OnFrame({.stream = 4, .sequence = sequence, .capture_time_us = capture_us}, frame,
                         now_us_);
  }

  Feed feed_{protocol::SubscribeWeights{}};
  std::uint64_t names_hash_ = 0;
  std::int64_t now_us_ = 1'000'000;
};

TEST_F(FeedTest, StartsEmptyAndKeepsTheNewestFrame) {
  EXPECT_EQ(feed_.status(), FURROW_NO_DATA);
  EXPECT_EQ(feed_.layout(), names_hash_);
  EXPECT_EQ(Frame(7, 70), Arrival::kNew);
  EXPECT_EQ(feed_.status(), FURROW_OK);
  EXPECT_EQ(feed_.values(), (std::vector{0.25f, 0.5f}));
  const furrow_frame frame = feed_.Frame(now_us_ + 30);
  EXPECT_EQ(frame.count, 2u);
  EXPECT_EQ(frame.sequence, 7u);
  EXPECT_EQ(frame.layout, names_hash_);
  EXPECT_EQ(frame.number, 1u);
  EXPECT_EQ(frame.missed, 0u);
  EXPECT_EQ(frame.capture_time_us, 70);
  EXPECT_EQ(frame.age_us, 30);
  EXPECT_EQ(frame.flags, 0u);
}

TEST_F(FeedTest, FramesHaveTheTimecodeOfTheirPose) {
  const auto receive = [this](std::uint32_t sequence, std::optional<Timecode> timecode) {
    protocol::WeightFrame frame;
    frame.names_hash = names_hash_;
    frame.values = {0.25f, 0.5f};
    frame.timecode = timecode;
    EXPECT_EQ(feed_.OnFrame({.stream = 4, .sequence = sequence, .capture_time_us = sequence}, frame,
                            now_us_),
              Arrival::kNew);
    return feed_.Frame(now_us_);
  };
  EXPECT_STREQ(receive(1, std::nullopt).timecode, "");
  const furrow_frame frame = receive(2, MakeTimecode(17'982, 0.0, 30'000, 1001));
  EXPECT_STREQ(frame.timecode, "00:10:00;00");
  EXPECT_EQ(frame.timecode_rate_numerator, 30'000u);
  EXPECT_EQ(frame.timecode_rate_denominator, 1001u);
  EXPECT_STREQ(receive(3, ParseTimecode("23:59:59:239", 240)).timecode, "23:59:59:239");
  EXPECT_EQ(receive(4, std::nullopt).timecode_rate_numerator, 0u) << "not kept";
}

TEST_F(FeedTest, LateAndRepeatedFramesAreIgnored) {
  EXPECT_EQ(Frame(10, 100), Arrival::kNew);
  EXPECT_EQ(Frame(9, 90, 0, {1.0f, 1.0f}), Arrival::kLate);
  EXPECT_EQ(Frame(10, 100, 0, {1.0f, 1.0f}), Arrival::kLate);
  EXPECT_EQ(feed_.values()[0], 0.25f);
  EXPECT_EQ(Frame(10, 100, 500), Arrival::kNew) << "the same pose, decaying";
  EXPECT_EQ(feed_.Frame(now_us_ + 7).age_us, 507);
  EXPECT_EQ(feed_.Frame(now_us_).flags, FURROW_FRAME_DECAYING);
}

TEST_F(FeedTest, ARestartedPublisherCountsFromZero) {
  EXPECT_EQ(Frame(30, 3000), Arrival::kNew);
  EXPECT_EQ(Frame(0, 3100), Arrival::kNew) << "its clock goes on";
  EXPECT_EQ(Frame(5000, 500'000), Arrival::kNew);
  EXPECT_EQ(Frame(0, 0), Arrival::kNew)
      << "its clock starts again, but nothing is reordered so far";
  EXPECT_EQ(Frame(40, 4000), Arrival::kNew);
  now_us_ += 300'000;
  EXPECT_EQ(Frame(1, 10), Arrival::kNew) << "its clock starts again, after a pause";
}

TEST_F(FeedTest, MissedPosesAreCountedAcrossTheWrap) {
  EXPECT_EQ(Frame(std::numeric_limits<std::uint32_t>::max() - 1, 1), Arrival::kNew);
  EXPECT_EQ(Frame(1, 2), Arrival::kNew);
  EXPECT_EQ(feed_.Frame(0).missed, 2u);
  EXPECT_EQ(Frame(2, 3), Arrival::kNew);
  EXPECT_EQ(feed_.Frame(0).missed, 2u);
  EXPECT_EQ(Frame(2'000'000'000, 4), Arrival::kNew);
  EXPECT_EQ(feed_.Frame(0).missed, 2u) << "a restart is not a loss";
}

TEST_F(FeedTest, FramesWithOtherNamesAreIgnored) {
  EXPECT_EQ(Frame(1, 1, 0, {0.5f}), Arrival::kUnknownNames);
  EXPECT_EQ(Frame(1, 1, 0, {}), Arrival::kUnknownNames);
  names_hash_ ^= 1;
  EXPECT_EQ(Frame(1, 1), Arrival::kUnknownNames);
  EXPECT_EQ(feed_.status(), FURROW_NO_DATA);
}

TEST_F(FeedTest, ANewLayoutForgetsTheOldWeights) {
  EXPECT_EQ(Frame(5, 50), Arrival::kNew);
  const std::uint64_t before = feed_.layout();
  EXPECT_FALSE(Name({"brow.a", "brow.b"})) << "nothing has changed";
  EXPECT_EQ(feed_.status(), FURROW_OK);
  EXPECT_TRUE(Name({"brow.b", "brow.a"}));
  EXPECT_NE(feed_.layout(), before) << "the order matters";
  EXPECT_EQ(feed_.status(), FURROW_NO_DATA);
  EXPECT_EQ(Frame(5, 50), Arrival::kNew) << "the same pose under the new rig";
}

TEST_F(FeedTest, WeightsStayWithinZeroAndOne) {
  EXPECT_EQ(Frame(1, 1, 0, {-0.5f, 7.0f}), Arrival::kNew);
  EXPECT_EQ(feed_.values(), (std::vector{0.0f, 1.0f}));
}

TEST_F(FeedTest, AHugeAgeDoesNotOverflow) {
  EXPECT_EQ(Frame(1, 1, std::numeric_limits<std::int64_t>::max()), Arrival::kNew);
  EXPECT_GT(feed_.Frame(now_us_ + 1'000'000'000).age_us, 0);
}

TEST_F(FeedTest, ARejectedRequestIsDueAgainOnce) {
  feed_.OnError(FURROW_NO_MATCH, 500);
  EXPECT_EQ(feed_.status(), FURROW_NO_MATCH);
  EXPECT_FALSE(feed_.TakeRetry(499));
  EXPECT_TRUE(feed_.TakeRetry(500));
  EXPECT_FALSE(feed_.TakeRetry(501));
  Name({"brow.a", "brow.b"});
  EXPECT_EQ(feed_.status(), FURROW_NO_DATA);
}

TEST_F(FeedTest, ASubjectThatLeftIsMarkedUntilItReturns) {
  EXPECT_EQ(Frame(1, 1), Arrival::kNew);
  feed_.OnSubjectGone();
  EXPECT_EQ(feed_.Frame(now_us_).flags, FURROW_FRAME_SUBJECT_GONE);
  EXPECT_EQ(Frame(2, 2), Arrival::kNew);
  EXPECT_EQ(feed_.Frame(now_us_).flags, 0u);
}

}  // namespace
}  // namespace furrow::capi

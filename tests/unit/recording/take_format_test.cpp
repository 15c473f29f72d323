// SPDX-License-Identifier: Apache-2.0
#include "recording/take_format.h"

#include <limits>

#include <gtest/gtest.h>

namespace furrow::recording {
namespace {

TEST(TakeFormat, TopicsRoundTripForAnySubject) {
  for (const char* subject : {"ada", "stage/left", "pose", "raw", "Ünï 7"}) {
    for (int i = 0; i < static_cast<int>(TakeKind::kDatagram); ++i) {
      const auto kind = static_cast<TakeKind>(i);
      TakeKind back_kind = TakeKind::kDatagram;
      std::string back;
      ASSERT_TRUE(ParseTopic(TopicOf(kind, subject), &back_kind, &back)) << subject;
      EXPECT_EQ(back_kind, kind);
      EXPECT_EQ(back, subject);
    }
  }
  TakeKind kind = TakeKind::kPose;
  std::string subject = "somebody";
  ASSERT_TRUE(ParseTopic("/raw/udp", &kind, &subject));
  EXPECT_EQ(kind, TakeKind::kDatagram);
  EXPECT_EQ(subject, "");
}

TEST(TakeFormat, RejectsForeignTopics) {
  TakeKind kind = TakeKind::kPose;
  std::string subject;
  for (const char* topic : {"", "/", "pose", "/pose", "//pose", "ada/pose", "/ada/", "/ada/image"})
    EXPECT_FALSE(ParseTopic(topic, &kind, &subject)) << topic;
}

TEST(TakeFormat, EveryKindHasItsBinarySchema) {
  for (int i = 0; i < static_cast<int>(TakeKind::kDatagram); ++i) {
    const auto schema = BinarySchema(static_cast<TakeKind>(i));
    ASSERT_GT(schema.size(), 8u);
    // The file identifier of FlatBuffers' binary schemas.
    EXPECT_EQ(std::string(schema.begin() + 4, schema.begin() + 8), "BFBS");
    const std::string text(schema.begin(), schema.end());
    EXPECT_NE(text.find(SchemaName(static_cast<TakeKind>(i))), std::string::npos);
  }
  EXPECT_TRUE(BinarySchema(TakeKind::kDatagram).empty());
}

TEST(TakeFormat, CaptureTimesOfAnyEpochRoundTrip) {
  for (const std::int64_t time : {std::int64_t{0}, std::int64_t{1'763'690'000'000'000},
                                  std::int64_t{-5}, std::int64_t{9'000'000'000'000'000}})
    EXPECT_EQ(FromPublishTime(ToPublishTime(time)), time);
  // Times more than 292 years from the epoch are clamped instead of wrapped.
  constexpr std::int64_t kFar = std::int64_t{1} << 62;
  EXPECT_GT(FromPublishTime(ToPublishTime(kFar)), 9'000'000'000'000'000);
  EXPECT_LT(FromPublishTime(ToPublishTime(-kFar)), -9'000'000'000'000'000);
}

}  // namespace
}  // namespace furrow::recording

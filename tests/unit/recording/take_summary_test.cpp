// SPDX-License-Identifier: Apache-2.0
#include "recording/take_summary.h"

#include "tests/unit/recording/take_testing.h"

namespace furrow::recording {
namespace {

class TakeSummaryTest : public TakeTest {};

TEST_F(TakeSummaryTest, CountsRatesAndGaps) {
  const auto writer = Create("take.mcap");
  WriteSubject(*writer, "ada", 3);
  for (const std::uint32_t i : {6u, 7u})  // 3, 4 and 5 are missing
    ASSERT_TRUE(writer->Write(TakeKind::kPose, "ada", Stamp(i), Payload(Pose(0.0f))).ok());
  // Another run of the sender restarts its numbers and its clock. That is not a gap.
  ASSERT_TRUE(writer->Write(TakeKind::kPose, "ada", Stamp(100, 6), Payload(Pose(0.0f))).ok());
  const DatagramSender sender{};
  ASSERT_TRUE(writer->WriteDatagram(sender, Stamp(200).log_time_ns, Payload(Pose(0.0f))).ok());
  ASSERT_TRUE(writer->Close().ok());
  const auto summary = Summarise(*Open("take.mcap"));
  ASSERT_TRUE(summary.ok());
  EXPECT_EQ(summary->messages, 8u);
  EXPECT_EQ(summary->datagrams, 1u);
  EXPECT_NEAR(summary->seconds(), 2.0, 1e-9);
  const SubjectSummary& ada = summary->subjects.at("ada");
  EXPECT_EQ(ada.joints, 2u);
  EXPECT_EQ(ada.blend_shapes, 1u);
  EXPECT_EQ(ada.skeletons, 1u);
  EXPECT_EQ(ada.sessions.size(), 2u);
  EXPECT_EQ(ada.poses, 6u);
  EXPECT_EQ(ada.missing, 3u);
  EXPECT_NEAR(ada.longest_gap, 0.04, 1e-9);
  EXPECT_NEAR(ada.rate(), 4 / 0.07, 1e-6) << "four steps in 70 ms";
}

TEST_F(TakeSummaryTest, AttachesAndCountsDifferentSkeletons) {
  const auto writer = Create("take.mcap");
  for (const float length : {2.0f, 2.0f, 3.0f})
    ASSERT_TRUE(
        writer->Write(TakeKind::kSkeleton, "ada", Stamp(0), Payload(Offer("ada", length))).ok());
  ASSERT_TRUE(writer->Close().ok());
  const auto take = Open("take.mcap");
  EXPECT_EQ(take->file().attachments().size(), 3u) << "the rig, two skeletons";
  const auto summary = Summarise(*take);
  ASSERT_TRUE(summary.ok());
  EXPECT_EQ(summary->subjects.at("ada").skeletons, 2u);
}

}  // namespace
}  // namespace furrow::recording

// SPDX-License-Identifier: Apache-2.0
#include "recording/take_poses.h"

#include <fstream>
#include <limits>

#include "recording/take_clip.h"
#include "tests/unit/recording/take_testing.h"

namespace furrow::recording {
namespace {

class TakePosesTest : public TakeTest {};

TEST_F(TakePosesTest, ReturnsPosesAndTimesUnchanged) {
  const auto writer = Create("take.mcap");
  WriteSubject(*writer, "ada", 5);
  ASSERT_TRUE(writer->Close().ok());
  motion::ClipReport report;
  const auto poses = TakePoses::Load(*Open("take.mcap"), "", &report);
  ASSERT_TRUE(poses.ok()) << poses.status().ToString();
  EXPECT_TRUE(report.warnings.empty());
  EXPECT_EQ(poses->offer().subject, "ada");
  ASSERT_EQ(poses->size(), 5u);
  protocol::PoseFrame pose;
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_NEAR(poses->times()[i], 0.01 * static_cast<double>(i), 1e-12);
    poses->Get(i, &pose);
    ASSERT_EQ(pose.blend_shapes.size(), 1u);
    EXPECT_EQ(pose.blend_shapes[0], 0.01f * static_cast<float>(i));
  }
}

TEST_F(TakePosesTest, ARestartedSenderContinuesByArrivalTime) {
  const auto writer = Create("take.mcap");
  WriteSubject(*writer, "ada", 2);
  TakeStamp stamp = Stamp(0, /*session=*/6);
  stamp.capture_time_us = 3;
  stamp.log_time_ns = Stamp(1).log_time_ns + 500'000'000;
  ASSERT_TRUE(writer->Write(TakeKind::kPose, "ada", stamp, Payload(Pose(1.0f))).ok());
  ASSERT_TRUE(writer->Close().ok());
  const auto poses = TakePoses::Load(*Open("take.mcap"), "ada", nullptr);
  ASSERT_TRUE(poses.ok());
  ASSERT_EQ(poses->size(), 3u);
  EXPECT_NEAR(poses->times()[2], 0.51, 1e-12);
}

TEST_F(TakePosesTest, SkipsForeignAndUnreadablePosesWithAWarning) {
  const auto writer = Create("take.mcap");
  WriteSubject(*writer, "ada", 2);
  auto broken = Payload(Pose(0.5f));
  broken.resize(broken.size() / 2);
  ASSERT_TRUE(writer->Write(TakeKind::kPose, "ada", Stamp(2), broken).ok());
  auto foreign = Pose(0.5f);
  foreign.skeleton_hash ^= 1;
  ASSERT_TRUE(writer->Write(TakeKind::kPose, "ada", Stamp(3), Payload(foreign)).ok());
  ASSERT_TRUE(writer->Close().ok());
  motion::ClipReport report;
  const auto poses = TakePoses::Load(*Open("take.mcap"), "", &report);
  ASSERT_TRUE(poses.ok());
  EXPECT_EQ(poses->size(), 2u);
  EXPECT_EQ(report.warnings.size(), 2u);
}

TEST_F(TakePosesTest, ASubjectWhosePosesAreAllUnreadableIsNotCalledAbsent) {
  const auto writer = Create("take.mcap");
  ASSERT_TRUE(writer->Write(TakeKind::kSkeleton, "ada", Stamp(0), Payload(Offer("ada"))).ok());
  ASSERT_TRUE(writer->Write(TakeKind::kPose, "ada", Stamp(1), std::vector<std::uint8_t>(9)).ok());
  ASSERT_TRUE(writer->Close().ok());
  for (const char* subject : {"", "ada"}) {
    const auto poses = TakePoses::Load(*Open("take.mcap"), subject, nullptr);
    EXPECT_EQ(poses.status().code(), StatusCode::kNotFound);
    EXPECT_EQ(poses.status().what(), "none of its poses is readable");
  }
}

TEST_F(TakePosesTest, OneOfSeveralSubjectsMustBeNamed) {
  const auto writer = Create("take.mcap");
  WriteSubject(*writer, "ada", 2);
  WriteSubject(*writer, "bob", 3);
  ASSERT_TRUE(writer->Close().ok());
  const auto take = Open("take.mcap");
  const auto unnamed = TakePoses::Load(*take, "", nullptr);
  EXPECT_EQ(unnamed.status().code(), StatusCode::kInvalidArgument);
  EXPECT_NE(unnamed.status().ToString().find("ada, bob"), std::string::npos);
  EXPECT_EQ(TakePoses::Load(*take, "eve", nullptr).status().code(), StatusCode::kNotFound);
  const auto bob = TakePoses::Load(*take, "bob", nullptr);
  ASSERT_TRUE(bob.ok());
  EXPECT_EQ(bob->size(), 3u);
}

TEST_F(TakePosesTest, KeepsTheStartOfEachSubject) {
  const auto writer = Create("take.mcap");
  WriteSubject(*writer, "zoe", 2);
  TakeStamp late = Stamp(0, /*session=*/8);
  late.log_time_ns += 2'500'000'000;
  ASSERT_TRUE(writer->Write(TakeKind::kSkeleton, "ada", late, Payload(Offer("ada"))).ok());
  ASSERT_TRUE(writer->Write(TakeKind::kPose, "ada", late, Payload(Pose(0.0f))).ok());
  ASSERT_TRUE(writer->Close().ok());
  const auto all = TakePoses::LoadAll(*Open("take.mcap"), "", nullptr);
  ASSERT_TRUE(all.ok()) << all.status().ToString();
  ASSERT_EQ(all->size(), 2u);
  EXPECT_EQ((*all)[0].offer().subject, "zoe");
  EXPECT_EQ((*all)[0].start(), 0.0);
  EXPECT_EQ((*all)[1].offer().subject, "ada");
  EXPECT_NEAR((*all)[1].start(), 2.5, 1e-9);
  const auto one = TakePoses::LoadAll(*Open("take.mcap"), "ada", nullptr);
  ASSERT_TRUE(one.ok());
  ASSERT_EQ(one->size(), 1u);
  EXPECT_EQ(one->front().start(), 0.0);
}

TEST_F(TakePosesTest, UsesArrivalTimesWhenTheClockLeaps) {
  constexpr std::int64_t kHour = 3'600'000'000;
  const std::int64_t clocks[] = {0, kHour, std::numeric_limits<std::int64_t>::min(),
                                 std::numeric_limits<std::int64_t>::max(), kHour};
  const auto writer = Create("take.mcap");
  WriteSubject(*writer, "ada", 1);
  for (int i = 1; i < 5; ++i) {
    TakeStamp stamp = Stamp(0);
    stamp.capture_time_us = clocks[i];
    stamp.log_time_ns += static_cast<std::uint64_t>(i) * 20'000'000;
    ASSERT_TRUE(writer->Write(TakeKind::kPose, "ada", stamp, Payload(Pose(1.0f))).ok());
  }
  ASSERT_TRUE(writer->Close().ok());
  const auto poses = TakePoses::Load(*Open("take.mcap"), "ada", nullptr);
  ASSERT_TRUE(poses.ok());
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(poses->times()[i], 0.02 * double(i), 1e-9);
}

TEST_F(TakePosesTest, ConvertsCompleteAndPartialPosesToAClip) {
  const auto writer = Create("take.mcap");
  WriteSubject(*writer, "ada", 2);
  auto partial = Pose(0.0f);
  partial.partial = true;
  partial.rotations.clear();
  partial.rotation_joints.clear();
  partial.translations.clear();
  partial.translation_joints.clear();
  partial.blend_shapes = {0.75f};
  ASSERT_TRUE(writer->Write(TakeKind::kPose, "ada", Stamp(2), Payload(partial)).ok());
  ASSERT_TRUE(writer->Close().ok());
  const auto clip = LoadTakeClip((folder_ / "take.mcap#ada").string(), /*scale=*/0.5f);
  ASSERT_TRUE(clip.ok()) << clip.status().ToString();
  ASSERT_EQ(clip->num_frames(), 3);
  EXPECT_EQ(clip->name, "ada");
  EXPECT_EQ(clip->skeleton.rest_pose()[1].translation.y, 1.0f) << "2 units, scaled";
  const auto knee = [&](std::size_t frame) { return clip->locals[2 * frame + 1].translation.y; };
  EXPECT_EQ(knee(0), 1.0f);
  EXPECT_EQ(knee(1), 1.5f) << "lifted by 1 unit";
  EXPECT_EQ(knee(2), 1.5f) << "a partial pose keeps the other values";
  EXPECT_EQ(clip->blend_shapes[2], 0.75f);
}

TEST_F(TakePosesTest, ParsesTheFirstSubjectOfBytes) {
  const auto writer = Create("take.mcap");
  WriteSubject(*writer, "ada", 2);
  WriteSubject(*writer, "bob", 3);
  ASSERT_TRUE(writer->Close().ok());
  std::ifstream file(folder_ / "take.mcap", std::ios::binary);
  const std::vector<char> text(std::istreambuf_iterator<char>(file), {});
  const std::vector<std::uint8_t> bytes(text.begin(), text.end());
  motion::ClipReport report;
  const auto clip = ParseTakeClip(bytes, "take.mcap", &report);
  ASSERT_TRUE(clip.ok()) << clip.status().ToString();
  EXPECT_EQ(clip->name, "ada");
  EXPECT_EQ(clip->num_frames(), 2);
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_NE(report.warnings[0].find("2 subjects"), std::string::npos) << report.warnings[0];
  EXPECT_EQ(ParseTakeClip(std::span(bytes).first(100), "cut.mcap").status().where(), "cut.mcap");
}

TEST_F(TakePosesTest, PathsMayNameASubject) {
  std::string file;
  std::string subject;
  SplitTakePath("a/b.mcap#stage/left", &file, &subject);
  EXPECT_EQ(file, "a/b.mcap");
  EXPECT_EQ(subject, "stage/left");
  EXPECT_TRUE(IsTakePath("B.MCAP#x"));
  EXPECT_FALSE(IsTakePath("a.bvh#x.mcapped"));
  const std::string odd = (folder_ / "odd.mcap#1.mcap").string();
  std::ofstream(odd) << "x";
  SplitTakePath(odd, &file, &subject);
  EXPECT_EQ(file, odd) << "a file with the whole name exists";
}

}  // namespace
}  // namespace furrow::recording

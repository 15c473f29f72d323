// SPDX-License-Identifier: Apache-2.0
#include "motion/pose_source.h"

#include <chrono>
#include <cmath>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/motion/clip_testing.h"

namespace furrow::motion {
namespace {

using ::testing::HasSubstr;

std::string Bvh(int angle) {
  return "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\nEnd Site\n{\nOFFSET 0 1 "
         "0\n}\n}\n"
         "MOTION\nFrames: 2\nFrame Time: 1\n0\n" +
         std::to_string(angle) + "\n";
}

class PoseSourceTest : public ::testing::Test {
 protected:
  void Write(const std::string& text) { std::ofstream(path_, std::ios::trunc) << text; }

  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_.path() / "a.bvh";
};

TEST_F(PoseSourceTest, ReturnsOneFrame) {
  Write(Bvh(180));
  const Result<wrinkle::PoseFrame> frame = CachedPoseSource()(path_, 1);
  ASSERT_TRUE(frame.ok()) << frame.status().ToString();
  EXPECT_EQ(frame->skeleton.num_joints(), 1);
  EXPECT_NEAR(std::abs(frame->pose.joints[0].rotation.x), 1.0f, 1e-6f);
}

TEST_F(PoseSourceTest, ReportsTheNumberOfFrames) {
  Write(Bvh(0));
  for (const int frame : {-1, 2}) {
    const Result<wrinkle::PoseFrame> result = CachedPoseSource()(path_, frame);
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.status().code(), StatusCode::kInvalidArgument);
    EXPECT_THAT(result.status().ToString(), HasSubstr("has 2"));
    EXPECT_THAT(result.status().ToString(), HasSubstr("a.bvh"));
  }
  EXPECT_EQ(CachedPoseSource()(folder_.path() / "b.bvh", 0).status().code(), StatusCode::kNotFound);
}

TEST_F(PoseSourceTest, ReturnsBlendShapesWithTheirNames) {
  const std::filesystem::path path = folder_.path() / "c.csv";
  std::ofstream(path) << "Timecode,JawOpen,BrowInnerUp\n00:00:00:00,0,0\n00:00:00:01,0.75,0.5\n";
  const Result<wrinkle::PoseFrame> frame = CachedPoseSource()(path, 1);
  ASSERT_TRUE(frame.ok()) << frame.status().ToString();
  EXPECT_EQ(frame->skeleton.num_joints(), 0);
  ASSERT_EQ(frame->blend_shape_names.size(), frame->pose.blend_shapes.size());
  ASSERT_GE(frame->blend_shape_names.size(), 2u);
  EXPECT_NEAR(frame->pose.blend_shapes[0] + frame->pose.blend_shapes[1], 1.25f, 1e-6f);
}

// The test rewrites the file with the same size and time, which the source cannot detect. The old
// pose proves that the second call did not read the file.
TEST_F(PoseSourceTest, KeepsTheRecordingUntilTheFileChanges) {
  Write(Bvh(100));
  const auto time = std::filesystem::last_write_time(path_);
  const wrinkle::PoseSource source = CachedPoseSource();
  const Result<wrinkle::PoseFrame> first = source(path_, 1);
  ASSERT_TRUE(first.ok());
  Write(Bvh(120));
  std::filesystem::last_write_time(path_, time);
  const Result<wrinkle::PoseFrame> cached = source(path_, 1);
  ASSERT_TRUE(cached.ok());
  EXPECT_EQ(cached->pose.joints[0].rotation, first->pose.joints[0].rotation);
  std::filesystem::last_write_time(path_, time + std::chrono::seconds(2));
  const Result<wrinkle::PoseFrame> fresh = source(path_, 1);
  ASSERT_TRUE(fresh.ok());
  EXPECT_NE(fresh->pose.joints[0].rotation, first->pose.joints[0].rotation);
  std::filesystem::remove(path_);
  EXPECT_EQ(source(path_, 1).status().code(), StatusCode::kNotFound);
}

}  // namespace
}  // namespace furrow::motion

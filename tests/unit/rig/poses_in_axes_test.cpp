// SPDX-License-Identifier: Apache-2.0
#include "rig/poses_in_axes.h"

#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "rig/rig_file.h"
#include "tests/unit/rig/shipped_matcher.h"
#include "tests/unit/rig/turned_face.h"

namespace furrow::rig {
namespace {

// The source file of this test stands for the recording.
constexpr char kFile[] = "poses_in_axes_test.cpp";
const std::filesystem::path kFolder = FURROW_SOURCE_DIR "/tests/unit/rig";

wrinkle::PoseSource FramesOf(const motion::Clip& clip) {
  return [clip](const std::filesystem::path&, int frame) -> Result<wrinkle::PoseFrame> {
    wrinkle::PoseFrame result{clip.skeleton, {}};
    clip.GetPose(frame, &result.pose);
    return result;
  };
}

TEST(PosesInFurrowAxes, RigAndStreamOfOneFileAgree) {
  const auto matcher = ShippedMatcher();
  ASSERT_TRUE(matcher.ok()) << matcher.status().ToString();
  for (const glm::quat& turn : TurnsOfFiles()) {
    const motion::Clip clip = RaisedBrow(turn);
    const auto rig = ParseRig(RaisedBrowRig(kFile), "r.json", kFolder,
                              PosesInFurrowAxes(FramesOf(clip), *matcher));
    ASSERT_TRUE(rig.ok()) << rig.status().ToString();
    EXPECT_NEAR(FirstValue(*rig, *matcher, clip, 1), 1.0f, 1e-4f);
    EXPECT_NEAR(FirstValue(*rig, *matcher, clip, 0), 0.0f, 1e-4f);
    // The rig is in Furrow's axes, so a stream in other axes agrees, too.
    EXPECT_NEAR(FirstValue(*rig, *matcher, RaisedBrow({1, 0, 0, 0}), 1), 1.0f, 1e-4f);
  }
}

TEST(PosesInFurrowAxes, FurrowsAxesStayAsTheyAre) {
  const auto matcher = ShippedMatcher();
  ASSERT_TRUE(matcher.ok()) << matcher.status().ToString();
  const motion::Clip clip = RaisedBrow({1, 0, 0, 0});
  const auto frame = PosesInFurrowAxes(FramesOf(clip), *matcher)("x", 1);
  ASSERT_TRUE(frame.ok());
  EXPECT_EQ(frame->skeleton.hash(), clip.skeleton.hash());
  EXPECT_EQ(frame->pose.joints[5].translation, clip.locals[16 + 5].translation);
}

TEST(PosesInFurrowAxes, PassesErrorsAndPosesOfUnknownBodiesOn) {
  const auto matcher = ShippedMatcher();
  ASSERT_TRUE(matcher.ok()) << matcher.status().ToString();
  const wrinkle::PoseSource fails = [](const std::filesystem::path&, int) {
    return Result<wrinkle::PoseFrame>(Status(StatusCode::kNotFound, "nothing"));
  };
  EXPECT_EQ(PosesInFurrowAxes(fails, *matcher)("x", 0).status().code(), StatusCode::kNotFound);
  wrinkle::PoseFrame frame;
  frame.skeleton = *wrinkle::Skeleton::Create({{"a", -1, {{1, 2, 3}}, {}}});  // and no pose
  const wrinkle::PoseSource odd = [&](const std::filesystem::path&, int) {
    return Result<wrinkle::PoseFrame>(frame);
  };
  std::vector<std::string> warnings;
  const auto poses = PosesInFurrowAxes(
      odd, *matcher, [&](const std::string& warning) { warnings.push_back(warning); });
  const auto read = poses("x", 0);
  EXPECT_TRUE(poses("x", 1).ok());
  EXPECT_THAT(warnings, testing::ElementsAre(testing::StartsWith("x: the axes of the rest pose")));
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(read->skeleton.hash(), frame.skeleton.hash());
  // A recording of a face alone has no axes.
  frame.skeleton = wrinkle::Skeleton();
  warnings.clear();
  EXPECT_TRUE(poses("face.csv", 0).ok());
  EXPECT_TRUE(warnings.empty());
  // A turned body with a pose of another length is left to the reader of rigs.
  frame.skeleton = RaisedBrow(TurnsOfFiles()[0]).skeleton;
  EXPECT_TRUE(PosesInFurrowAxes(odd, *matcher)("x", 0)->pose.joints.empty());
}

}  // namespace
}  // namespace furrow::rig

// SPDX-License-Identifier: Apache-2.0
#include "client/cli/common/inputs.h"

#include <cstdlib>
#include <fstream>

#include <gtest/gtest.h>

#include "motion/clip_file.h"
#include "tests/temporary_folder.h"
#include "tests/unit/rig/turned_face.h"

namespace furrow::cli {
namespace {

class RigInputs : public testing::Test {
 protected:
  void SetUp() override { setenv("FURROW_DATA_DIR", FURROW_SOURCE_DIR "/rig", 1); }
  void TearDown() override { unsetenv("FURROW_DATA_DIR"); }

  const TemporaryFolder folder_;
  const std::string rig_ = (folder_ / "face.json").string();
};

// A rig that takes its pose from the recording that is solved, in axes of any kind.
TEST_F(RigInputs, PosesOfARigAreInTheAxesOfRecordings) {
  std::ofstream(rig_) << rig::RaisedBrowRig("face.glb");
  const auto matcher = LoadSkeletonMatcher({});
  ASSERT_TRUE(matcher.ok()) << matcher.status().ToString();
  for (const glm::quat& turn : rig::TurnsOfFiles()) {
    ASSERT_TRUE(motion::SaveClip(rig::RaisedBrow(turn), folder_ / "face.glb").ok());
    const auto clip = LoadClipArgument((folder_ / "face.glb").string());
    ASSERT_TRUE(clip.ok()) << clip.status().ToString();
    const auto rig = LoadRigArgument(rig_);
    ASSERT_TRUE(rig.ok()) << rig.status().ToString();
    EXPECT_NEAR(rig::FirstValue(*rig, *matcher, *clip, 1), 1.0f, 1e-3f);
    const auto input = LoadRigInput(rig_);
    ASSERT_TRUE(input.ok()) << input.status().ToString();
    EXPECT_NEAR(rig::FirstValue(input->rig, *matcher, *clip, 1), 1.0f, 1e-3f);
  }
}

// --rest-frame is about the recording of a command.
TEST_F(RigInputs, PosesOfARigKeepTheirOwnRestPose) {
  std::ofstream(rig_) << rig::RaisedBrowRig("face.glb");
  ASSERT_TRUE(motion::SaveClip(rig::RaisedBrow({1, 0, 0, 0}), folder_ / "face.glb").ok());
  const auto rig = LoadRigArgument(rig_, {.rest_frame = 1});
  ASSERT_TRUE(rig.ok()) << rig.status().ToString();
  EXPECT_EQ(rig->reference_poses[0].joints.size(), 1u);
}

// Rigs and characters ship in different folders, and some have the same name.
TEST_F(RigInputs, ARigArgumentMayNameACharacter) {
  std::filesystem::create_directory(folder_ / "rigs");
  for (const char* name : {"default.glb", "elder.glb", "rigs/default.json"}) {
    std::ofstream(folder_ / name);
  }
  setenv("FURROW_DATA_DIR", folder_.path().c_str(), 1);
  EXPECT_EQ(FindPackageArgument("elder"), folder_ / "elder.glb");
  EXPECT_EQ(FindPackageArgument("default.glb"), folder_ / "default.glb");
  EXPECT_EQ(FindPackageArgument("no/such.glb"), "no/such.glb");
  EXPECT_EQ(FindPackageArgument("default"), "") << "the rig of this name";
  EXPECT_EQ(FindPackageArgument("nobody"), "");
  EXPECT_EQ(FindPackageArgument(rig_), "");
}

}  // namespace
}  // namespace furrow::cli

// SPDX-License-Identifier: Apache-2.0
#include "server/assets.h"

#include <cstdlib>
#include <fstream>

#include <gtest/gtest.h>

#include "motion/clip_file.h"
#include "tests/temporary_folder.h"
#include "tests/unit/rig/turned_face.h"

namespace furrow::server {
namespace {

// A rig that takes its pose from the recording that is streamed, in axes of any kind.
TEST(Assets, PosesOfARigAreInTheAxesOfStreams) {
  setenv("FURROW_DATA_DIR", FURROW_SOURCE_DIR "/rig", 1);
  const TemporaryFolder folder;
  const std::filesystem::path rig_file = folder / "face.json";
  std::ofstream(rig_file) << rig::RaisedBrowRig("face.glb");
  Config config;
  config.rig = rig_file;
  config.render = false;
  for (const glm::quat& turn : rig::TurnsOfFiles()) {
    ASSERT_TRUE(motion::SaveClip(rig::RaisedBrow(turn), folder / "face.glb").ok());
    const auto assets = LoadAssets(config);
    ASSERT_TRUE(assets.ok()) << assets.status().ToString();
    const auto clip = motion::LoadClip(folder / "face.glb");
    ASSERT_TRUE(clip.ok()) << clip.status().ToString();
    EXPECT_NEAR(rig::FirstValue(*assets->rig, assets->skeletons, *clip, 1), 1.0f, 1e-3f);
  }
  unsetenv("FURROW_DATA_DIR");
}

}  // namespace
}  // namespace furrow::server

// SPDX-License-Identifier: Apache-2.0
#include "server/assets.h"

#include <cstdlib>
#include <fstream>

#include <gtest/gtest.h>

#include "base/files.h"
#include "character/package/package.h"
#include "character/package/web_package.h"
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

std::string Stated(const std::filesystem::path& file) {
  const std::string bytes = *ReadFile(file, 1 << 20);
  return R"({"bytes":)" + std::to_string(bytes.size()) + R"(,"fnv1a":)" +
         std::to_string(character::Checksum(bytes)) + "}";
}

character::Character Ada() {
  character::Character ada;
  ada.skeleton = rig::BodyWithBrow();
  ada.inverse_bind_matrices.assign(static_cast<std::size_t>(ada.skeleton.num_joints()),
                                   glm::mat4(1.0f));
  ada.meshes.push_back(
      {.name = "triangle", .vertices = std::vector<character::Vertex>(3), .indices = {0, 1, 2}});
  ada.materials.emplace_back();
  return ada;
}

// Poses that stream already are for the character that was loaded first.
TEST(Assets, PicturesThatComeLaterAreOfTheSameCharacter) {
  setenv("FURROW_DATA_DIR", FURROW_SOURCE_DIR "/rig", 1);
  const TemporaryFolder folder;
  Config config;
  config.character = folder / "ada.glb";
  ASSERT_TRUE(character::SaveCharacterGlb(Ada(), config.character).ok());
  ASSERT_TRUE(motion::SaveClip(rig::RaisedBrow({1, 0, 0, 0}), folder / "face.glb").ok());
  std::ofstream(folder / "ada.rig.json") << rig::RaisedBrowRig("face.glb");
  const auto former = LoadAssets(config, character::Pictures::kLeaveOut);
  ASSERT_TRUE(former.ok()) << former.status().ToString();
  EXPECT_TRUE(former->lacks_pictures);
  const auto same = LoadWithPictures(config, *former->character);
  ASSERT_TRUE(same.ok()) << same.status().ToString();
  EXPECT_FALSE(same->lacks_pictures);

  character::Character moved = Ada();
  std::vector<wrinkle::JointDesc> joints;
  for (int joint = 0; joint < moved.skeleton.num_joints(); ++joint) {
    const auto at = static_cast<std::size_t>(joint);
    joints.push_back({.name = moved.skeleton.joint_names()[at],
                      .parent = moved.skeleton.joint_parents()[at],
                      .rest = moved.skeleton.rest_pose()[at]});
  }
  joints.back().rest.translation.y += 0.1f;
  moved.skeleton = *wrinkle::Skeleton::Create(joints);
  ASSERT_TRUE(character::SaveCharacterGlb(moved, config.character).ok());
  EXPECT_EQ(LoadWithPictures(config, *former->character).status().code(), StatusCode::kUnavailable);

  ASSERT_TRUE(character::SaveCharacterGlb(Ada(), config.character).ok());
  Config without = config;
  without.character.clear();
  without.render = false;
  without.rig = folder / "ada.rig.json";
  EXPECT_EQ(LoadWithPictures(without, *former->character).status().code(), StatusCode::kUnavailable)
      << "no character at all";
  unsetenv("FURROW_DATA_DIR");
}

TEST(Assets, BrowsersGetThePackageOfThisCharacterOnly) {
  setenv("FURROW_DATA_DIR", FURROW_SOURCE_DIR "/rig", 1);
  const TemporaryFolder folder;
  Config config;
  config.character = folder / "ada.glb";
  const character::Character ada = Ada();
  ASSERT_TRUE(character::SaveCharacterGlb(ada, config.character).ok());
  ASSERT_TRUE(motion::SaveClip(rig::RaisedBrow({1, 0, 0, 0}), folder / "face.glb").ok());
  std::ofstream(folder / "ada.rig.json") << rig::RaisedBrowRig("face.glb");
  const auto web_package = [&] {
    const auto assets = LoadAssets(config);
    EXPECT_TRUE(assets.ok()) << assets.status().ToString();
    if (!assets.ok()) return std::filesystem::path("failed");
    return assets->package.empty() ? assets->package : FindWebPackage(assets->package);
  };
  EXPECT_EQ(web_package(), "") << "there is none";
  std::ofstream(folder / "ada.web.glb")
      << R"({"scenes":[{"extras":{"furrow_source":{"character":)" << Stated(config.character)
      << R"(,"rig":)" << Stated(folder / "ada.rig.json") << "}}}]}";
  EXPECT_EQ(web_package(), folder / "ada.web.glb");
  config.rig = folder / "ada.rig.json";
  EXPECT_EQ(web_package(), "") << "another rig";
  config.rig.clear();
  std::ofstream(folder / "ada.rig.json", std::ios::app) << "\n";
  EXPECT_EQ(web_package(), "") << "the rig has changed";
  unsetenv("FURROW_DATA_DIR");
}

}  // namespace
}  // namespace furrow::server

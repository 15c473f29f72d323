// SPDX-License-Identifier: Apache-2.0
#include "client/cli/render/pose_clip.h"

#include <gtest/gtest.h>

namespace furrow::cli {
namespace {

using wrinkle::kNoJoint;

// A head with two brows. Lowering either brow feeds map `squash`.
character::Character Brows() {
  character::Character character;
  auto skeleton =
      wrinkle::Skeleton::Create({{"head", kNoJoint, {}}, {"brow_l", 0, {}}, {"brow_r", 0, {}}});
  EXPECT_TRUE(skeleton.ok());
  character.skeleton = *skeleton;
  const glm::quat still(1, 0, 0, 0);
  character.rig.reference_poses = {{"lower_l", {{"brow_l", still, {0, -1, 0}}}, 0},
                                   {"lower_r", {{"brow_r", still, {0, -2, 0}}}, 0},
                                   {"nod", {{"head", still, {0, 0, 3}}}, 0}};
  for (const char* side : {"l", "r"}) {
    wrinkle::Driver driver;
    driver.name = std::string("brow_") + side;
    driver.pose.values = {{"squash", std::string("lower_") + side}};
    character.rig.drivers.push_back(driver);
    wrinkle::Region region;
    region.name = driver.name;
    region.feeds = {{"squash", {{driver.name, "squash", 1.0f}}}};
    character.rig.regions.push_back(region);
  }
  return character;
}

TEST(PoseClip, NeutralIsTheRestPose) {
  const auto clip = PoseClip(Brows(), "neutral");
  ASSERT_TRUE(clip.ok());
  ASSERT_EQ(clip->num_frames(), 1);
  for (const wrinkle::Transform& local : clip->locals)
    EXPECT_EQ(local.translation, glm::vec3(0.0f));
}

TEST(PoseClip, WeightsScalePosesAndPosesAddUp) {
  const auto clip = PoseClip(Brows(), "lower_l=0.5,nod,nod=-0.25");
  ASSERT_TRUE(clip.ok()) << clip.status().ToString();
  EXPECT_FLOAT_EQ(clip->locals[1].translation.y, -0.5f);
  EXPECT_FLOAT_EQ(clip->locals[0].translation.z, 3.0f * 0.75f);
  EXPECT_FLOAT_EQ(clip->locals[2].translation.y, 0.0f);
}

TEST(PoseClip, NeutralAddsNothing) {
  for (const char* text : {"neutral,nod", "nod,neutral"}) {
    const auto clip = PoseClip(Brows(), text);
    ASSERT_TRUE(clip.ok()) << clip.status().ToString();
    EXPECT_FLOAT_EQ(clip->locals[0].translation.z, 3.0f) << text;
  }
}

TEST(PoseClip, ANameWithoutSideMeansBothSidesAndAMapAllItsPoses) {
  for (const char* text : {"lower", "squash"}) {
    const auto clip = PoseClip(Brows(), text);
    ASSERT_TRUE(clip.ok()) << text;
    EXPECT_FLOAT_EQ(clip->locals[1].translation.y, -1.0f) << text;
    EXPECT_FLOAT_EQ(clip->locals[2].translation.y, -2.0f) << text;
  }
}

TEST(PoseClip, BlendShapesMayBeNamed) {
  const auto clip = PoseClip(Brows(), "nod,mouthSmile=0.5,JAWOPEN,jawOpen=0.25");
  ASSERT_TRUE(clip.ok()) << clip.status().ToString();
  EXPECT_FLOAT_EQ(clip->locals[0].translation.z, 3.0f);
  ASSERT_EQ(clip->blend_shapes.size(), clip->blend_shape_names.size());
  for (std::size_t i = 0; i < clip->blend_shapes.size(); ++i) {
    const std::string& name = clip->blend_shape_names[i];
    const float wanted = name.starts_with("mouthSmile") ? 0.5f : name == "jawOpen" ? 1.25f : 0.0f;
    EXPECT_FLOAT_EQ(clip->blend_shapes[i], wanted) << name;
  }
  EXPECT_TRUE(PoseClip(Brows(), "nod")->blend_shape_names.empty());
}

TEST(PoseClip, BlendShapesOfDriversMayBeNamed) {
  character::Character character = Brows();
  wrinkle::Driver& driver = character.rig.drivers.emplace_back();
  driver.name = "scar";
  driver.kind = wrinkle::Driver::Kind::kBlendShape;
  driver.blend_shape.blend_shape = "scarFold";
  const auto clip = PoseClip(character, "scarfold=0.75");
  ASSERT_TRUE(clip.ok()) << clip.status().ToString();
  EXPECT_EQ(clip->blend_shape_names.back(), "scarFold");
  EXPECT_FLOAT_EQ(clip->blend_shapes.back(), 0.75f);
}

TEST(PoseClip, ReferencePosesMoveTheirBlendShapes) {
  character::Character character = Brows();
  character.rig.reference_poses[2].shapes = {{"BrowInnerUp", 0.5f}, {"Fcl_ALL_Joy", 1.0f}};
  const auto clip = PoseClip(character, "nod=0.5,browInnerUp=0.25");
  ASSERT_TRUE(clip.ok()) << clip.status().ToString();
  EXPECT_FLOAT_EQ(clip->locals[0].translation.z, 1.5f);
  float sum = 0.0f;
  for (std::size_t i = 0; i < clip->blend_shape_names.size(); ++i) {
    sum += clip->blend_shapes[i];
    if (clip->blend_shape_names[i] == "browInnerUp") {
      EXPECT_FLOAT_EQ(clip->blend_shapes[i], 0.5f);
    }
    if (clip->blend_shape_names[i] == "Fcl_ALL_Joy") {
      EXPECT_FLOAT_EQ(clip->blend_shapes[i], 0.5f);
    }
  }
  EXPECT_FLOAT_EQ(sum, 1.0f);
}

// Alone, mouthClose would push each lip through the other.
TEST(PoseClip, MouthCloseIsAtMostJawOpen) {
  character::Character face = Brows();
  const glm::quat still(1, 0, 0, 0);
  face.rig.reference_poses.push_back({"jaw_open", {{"head", still, {0, -4, 0}}}, 0});
  face.rig.reference_poses.push_back({"jawOpen", {{"head", still, {0, -4, 0}}}, 0});
  face.rig.reference_poses.push_back({"mouthClose", {{"brow_l", still, {0, 3, 0}}}, 0});
  const auto closed = [&](const char* text) {
    const auto clip = PoseClip(face, text);
    EXPECT_TRUE(clip.ok()) << clip.status().ToString();
    return clip.ok() ? clip->locals[1].translation.y : -1.0f;
  };
  EXPECT_FLOAT_EQ(closed("mouthClose"), 0.0f);
  EXPECT_FLOAT_EQ(closed("mouthClose=0.4,jawOpen"), 1.2f);
  EXPECT_FLOAT_EQ(closed("mouthClose,jawOpen=0.5"), 1.5f);
  EXPECT_FLOAT_EQ(closed("jaw_open=0.5,mouthClose=0.8"), 1.5f) << "the same motion by another name";
  EXPECT_FLOAT_EQ(closed("mouthClose,jawOpen=-1"), 0.0f);
  EXPECT_FLOAT_EQ(closed("mouthClose=-0.5"), -1.5f) << "pulling the lips apart has no limit";
}

TEST(PoseClip, AnUnknownNameIsAnErrorThatListsTheValidNames) {
  const auto unknown = PoseClip(Brows(), "lower_l,smirk");
  EXPECT_EQ(unknown.status().code(), StatusCode::kNotFound);
  EXPECT_NE(unknown.status().ToString().find("lower_l, lower_r, nod"), std::string::npos);
  for (const char* text : {"nod=", "nod=x", "nod=5", "nod=nan", "nod=1 "})
    EXPECT_EQ(PoseClip(Brows(), text).status().code(), StatusCode::kParse) << text;
  for (const char* text : {"", "nod,", "=1"})
    EXPECT_EQ(PoseClip(Brows(), text).status().code(), StatusCode::kNotFound) << text;
}

TEST(PoseClip, TakesTheCharactersOwnShapes) {
  character::Character character = Brows();
  character.shapes = {"Blush", "browInnerUp", "MouthSmileLeft", "mouthSmileRight"};
  const auto clip = PoseClip(character, "blush=0.5,browInnerUp,mouthSmile=0.25");
  ASSERT_TRUE(clip.ok()) << clip.status().ToString();
  ASSERT_EQ(clip->blend_shape_names.size(), clip->blend_shapes.size());
  float blush = 0.0f, brow = 0.0f, smile = 0.0f;
  for (std::size_t i = 0; i < clip->blend_shape_names.size(); ++i) {
    if (clip->blend_shape_names[i] == "Blush") blush += clip->blend_shapes[i];
    if (clip->blend_shape_names[i] == "browInnerUp") brow += clip->blend_shapes[i];
    if (clip->blend_shape_names[i] == "mouthSmileLeft") smile += clip->blend_shapes[i];
  }
  EXPECT_EQ(blush, 0.5f);
  EXPECT_EQ(brow, 1.0f) << "once, though ARKit and the character have it";
  EXPECT_EQ(smile, 0.25f);
  EXPECT_EQ(PoseClip(Brows(), "blush").status().code(), StatusCode::kNotFound);
}

}  // namespace
}  // namespace furrow::cli

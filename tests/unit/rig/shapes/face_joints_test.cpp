// SPDX-License-Identifier: Apache-2.0
#include "rig/shapes/face_joints.h"

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "authoring/generator/blend_shapes/blend_shape_face.h"
#include "authoring/generator/default_character.h"
#include "character/mesh/moved_surface.h"
#include "rig/rig_file.h"
#include "rig/shapes/arkit_shapes.h"
#include "rig/shapes/rig_shapes.h"
#include "tests/unit/rig/shapes/shipped_shape_maps.h"
#include "tests/unit/rig/shipped_matcher.h"
#include "wrinkle/skeleton/reference_pose.h"
#include "wrinkle/solver/solver.h"

namespace furrow::rig {
namespace {

// The default head twice: with joints in its face, and with the 52 shapes made from them.
class FaceJointsTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    auto rig = LoadRig(FURROW_SOURCE_DIR "/rig/rigs/default.json");
    ASSERT_TRUE(rig.ok()) << rig.status().ToString();
    rig_ = new wrinkle::Rig(*std::move(rig));
    jointed_ =
        new character::Character(authoring::MakeDefaultCharacter(*rig_, {.texture_size = 64}));
    shaped_ = new character::Character(*jointed_);
    ASSERT_TRUE(authoring::MakeBlendShapeFace(shaped_).ok());
    surface_ = new wrinkle::MovedSurface(character::FindMovedSurface(shaped_->meshes));
  }
  static void TearDownTestSuite() {
    delete surface_;
    delete shaped_;
    delete jointed_;
    delete rig_;
  }

  // `turn`: of the stream's model space.
  // `names`: other names for the face's shapes.
  static wrinkle::JointShapes Match(const wrinkle::Skeleton& stream,
                                    const std::vector<std::string>& names = {}) {
    const auto matcher = ShippedMatcher();
    EXPECT_TRUE(matcher.ok());
    const SkeletonMatch match = matcher->Match(stream, *rig_, &shaped_->skeleton);
    std::vector<std::string> unmatched;
    for (const std::string& name : stream.joint_names()) {
      if (shaped_->skeleton.Find(name) == wrinkle::kNoJoint) unmatched.push_back(name);
    }
    return MatchFaceJoints({stream, match.stream.roles, match.turn(), unmatched},
                           {shaped_->skeleton, match.character.roles, *surface_,
                            names.empty() ? shaped_->shapes : names, shaped_->shape_rules},
                           ShippedShapeMatcher());
  }

  static std::vector<wrinkle::Transform> LocalsOf(const std::string& pose) {
    const auto found =
        std::ranges::find(rig_->reference_poses, pose, &wrinkle::ReferencePose::name);
    EXPECT_NE(found, rig_->reference_poses.end()) << pose;
    std::vector<wrinkle::Transform> locals(jointed_->skeleton.rest_pose().begin(),
                                           jointed_->skeleton.rest_pose().end());
    EXPECT_TRUE(wrinkle::ApplyReferencePose(*found, jointed_->skeleton, locals).ok());
    return locals;
  }

  // The weights for a reference pose of the rig, by name.
  static std::map<std::string, float> WeightsFor(const wrinkle::JointShapes& shapes,
                                                 const std::string& pose, float scale = 1.0f) {
    std::vector<wrinkle::Transform> locals = LocalsOf(pose);
    for (wrinkle::Transform& local : locals) local.translation *= scale;
    std::vector<float> weights(shaped_->shapes.size());
    EXPECT_EQ(shapes.Run(locals, weights), wrinkle::JobStatus::kOk);
    std::map<std::string, float> named;
    for (std::size_t i = 0; i < weights.size(); ++i) named[shaped_->shapes[i]] = weights[i];
    return named;
  }

  static wrinkle::Rig* rig_;
  static character::Character* jointed_;
  static character::Character* shaped_;
  static wrinkle::MovedSurface* surface_;
};
wrinkle::Rig* FaceJointsTest::rig_ = nullptr;
character::Character* FaceJointsTest::jointed_ = nullptr;
character::Character* FaceJointsTest::shaped_ = nullptr;
wrinkle::MovedSurface* FaceJointsTest::surface_ = nullptr;

TEST_F(FaceJointsTest, EachPoseOfTheJointsRaisesItsOwnShape) {
  const wrinkle::JointShapes shapes = Match(jointed_->skeleton);
  ASSERT_FALSE(shapes.empty());
  for (const char* pose :
       {"browInnerUp", "browDownLeft", "browDownRight", "browOuterUpRight", "jawOpen",
        "mouthSmileLeft", "mouthSmileRight", "mouthPucker", "noseSneerLeft"}) {
    const auto weights = WeightsFor(shapes, pose);
    const auto most =
        std::ranges::max_element(weights, {}, [](const auto& entry) { return entry.second; });
    EXPECT_EQ(most->first, pose) << most->second << " and " << weights.at(pose);
    EXPECT_GT(weights.at(pose), 0.5f) << pose;
  }
}

TEST_F(FaceJointsTest, AnOpenJawDoesNotMoveToTheSides) {
  const auto weights = WeightsFor(Match(jointed_->skeleton), "jawOpen");
  EXPECT_LT(weights.at("jawLeft"), 0.1f);
  EXPECT_LT(weights.at("jawRight"), 0.1f);
}

TEST_F(FaceJointsTest, RestGivesNothing) {
  const wrinkle::JointShapes shapes = Match(jointed_->skeleton);
  std::vector<float> weights(shaped_->shapes.size(), 1.0f);
  ASSERT_EQ(shapes.Run(jointed_->skeleton.rest_pose(), weights), wrinkle::JobStatus::kOk);
  for (const float weight : weights) EXPECT_NEAR(weight, 0.0f, 1e-4f);
}

// Streams in centimetres and with other axes give the same weights.
TEST_F(FaceJointsTest, UnitsAndAxesDoNotMatter) {
  std::vector<wrinkle::JointDesc> joints;
  const wrinkle::Skeleton& own = jointed_->skeleton;
  for (int j = 0; j < own.num_joints(); ++j) {
    const auto at = static_cast<std::size_t>(j);
    wrinkle::JointDesc joint{own.joint_names()[at], own.joint_parents()[at], own.rest_pose()[at],
                             100.0f * own.tails()[at]};
    joint.rest.translation *= 100.0f;
    joints.push_back(joint);
  }
  const auto large = wrinkle::Skeleton::Create(joints);
  ASSERT_TRUE(large.ok());
  const auto wanted = WeightsFor(Match(own), "mouthSmileLeft");
  const auto found = WeightsFor(Match(*large), "mouthSmileLeft", 100.0f);
  for (const auto& [name, weight] : wanted) EXPECT_NEAR(found.at(name), weight, 0.02f) << name;
}

// mouthClose is at most jawOpen by meaning: the same face under other names gives the same weights.
TEST_F(FaceJointsTest, NamesOfTheMouthDoNotMatter) {
  std::vector<std::string> names = shaped_->shapes;
  std::size_t jaw = 0, close = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == "jawOpen") jaw = i;
    if (names[i] == "mouthClose") close = i;
    names[i] = "head_" + names[i].substr(0, 1) + "x";  // means nothing
  }
  names[jaw] = "Jaw_Open";
  names[close] = "mouth_closed";
  for (const char* side : {"Left", "Right"}) {
    const auto blink = std::ranges::find(shaped_->shapes, std::string("eyeBlink") + side);
    names[static_cast<std::size_t>(blink - shaped_->shapes.begin())] =
        std::string("eyeBlinking_") + side;
  }
  const wrinkle::JointShapes own = Match(jointed_->skeleton);
  const wrinkle::JointShapes renamed = Match(jointed_->skeleton, names);
  ASSERT_FALSE(renamed.empty());
  // Alone, this pose asks for more mouthClose than jawOpen.
  std::vector<wrinkle::Transform> pose = LocalsOf("mouthClose");
  std::vector<float> a(names.size()), b(names.size());
  ASSERT_EQ(own.Run(pose, a), wrinkle::JobStatus::kOk);
  ASSERT_EQ(renamed.Run(pose, b), wrinkle::JobStatus::kOk);
  EXPECT_LE(b[close], b[jaw] + 1e-4f);
  EXPECT_EQ(a, b);
}

// A rig of blend shapes reads the shapes that the joints move, behind the stream's own.
TEST_F(FaceJointsTest, TheRigReadsTheShapes) {
  const auto rig = LoadRig(FURROW_SOURCE_DIR "/rig/rigs/arkit.json");
  ASSERT_TRUE(rig.ok()) << rig.status().ToString();
  const auto solver = std::make_shared<const wrinkle::JointShapes>(Match(jointed_->skeleton));
  const std::vector<std::string> stream = {"tracked"};
  const RigShapes shapes(ShippedShapeMatcher(), stream, *rig, {solver, shaped_->shapes});
  const auto names = shapes.source_names();
  ASSERT_EQ(names.size(), 1 + shaped_->shapes.size());
  EXPECT_EQ(names[0], "tracked");
  const auto binding =
      wrinkle::RigBinding::Create(*rig, jointed_->skeleton, shapes.driver_names(), {});
  ASSERT_TRUE(binding.ok()) << binding.status().ToString();
  EXPECT_TRUE(binding->missing_blend_shapes().empty());
  wrinkle::LocalPose pose{.joints = LocalsOf("browDownLeft"), .blend_shapes = {0.25f}};
  shapes.Extend(&pose);
  ASSERT_EQ(pose.blend_shapes.size(), shapes.size());
  EXPECT_EQ(pose.blend_shapes[0], 0.25f);
  const auto brow = std::ranges::find(names, "browDownLeft") - names.begin();
  EXPECT_GT(pose.blend_shapes[static_cast<std::size_t>(brow)], 0.5f);
}

TEST_F(FaceJointsTest, ABodyWithoutAFaceMovesNothing) {
  EXPECT_TRUE(Match(shaped_->skeleton).empty());
  EXPECT_TRUE(Match(wrinkle::Skeleton()).empty());
}

}  // namespace
}  // namespace furrow::rig

// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/bake_poses.h"

#include <cmath>

#include <glm/gtc/quaternion.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/scalar.h"

namespace furrow::authoring {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// A leg and a brow, with the hip at 1 m and the knee at 0.5 m. The bind pose is the rest pose.
character::Character Body() {
  character::Character body;
  body.skeleton =
      *wrinkle::Skeleton::Create({{"hip", -1, {{0, 1, 0}}, {}},
                                  {"knee", 0, {{0, -0.5f, 0}}, glm::vec3(0, -0.5f, 0)},
                                  {"brow", 0, {{0, 0.7f, 0.1f}}, glm::vec3(0, 0.01f, 0)}});
  for (const glm::mat4& model : body.skeleton.rest_model()) {
    body.inverse_bind_matrices.push_back(glm::inverse(model));
  }
  wrinkle::Rig& rig = body.rig;
  rig.reference_poses = {{.name = "up", .joints = {{"brow", {1, 0, 0, 0}, {0, 0.01f, 0}}}}};
  rig.drivers.resize(3);
  rig.drivers[0].name = "knee";
  rig.drivers[0].kind = wrinkle::Driver::Kind::kHinge;
  rig.drivers[0].hinge = {
      .parent = "hip", .joint = "knee", .axis = glm::vec3(1, 0, 0), .beta_degrees = 90};
  rig.drivers[1].name = "brow";
  rig.drivers[1].pose.points = {{.joint = "brow"}};
  rig.drivers[1].pose.values = {{"stretch", "up"}};
  rig.drivers[2].name = "blink";
  rig.drivers[2].kind = wrinkle::Driver::Kind::kBlendShape;
  rig.wrinkle_maps = {{.name = "folds", .surface = wrinkle::WrinkleMap::Surface::kCloth},
                      {.name = "stretch"}};
  rig.regions.resize(2);
  rig.regions[0].name = "knee";
  rig.regions[0].feeds = {{"folds", {{"knee", "flexed", 2.5f}, {"knee", "extended", 0.3f}}}};
  rig.regions[1].name = "brow";
  rig.regions[1].feeds = {{"stretch", {{"brow", "stretch", 0.7f}, {"blink", "value", 1.0f}}}};
  return body;
}

TEST(BakePoses, PosesEveryJointDriver) {
  const auto found = CollectBakePoses(Body());
  ASSERT_TRUE(found.ok()) << found.status().ToString();
  ASSERT_EQ(found->poses.size(), 2u);
  const BakePose& knee = found->poses[0];
  EXPECT_EQ(knee.map, "folds");
  EXPECT_EQ(knee.region, "knee");
  EXPECT_EQ(knee.weight, 1.0f);  // a gain above 1 does not deepen folds
  ASSERT_EQ(knee.skin_matrices.size(), 3u);
  // Bent by 90 degrees: the foot, at rest 0.5 m below the knee, is behind it.
  const glm::vec3 foot = knee.skin_matrices[1] * glm::vec4(0, 0, 0, 1);
  EXPECT_NEAR(glm::distance(foot, glm::vec3(0, 0.5f, -0.5f)), 0.0f, 1e-5f);
  const glm::vec3 hip = knee.skin_matrices[0] * glm::vec4(0, 1, 0, 1);
  EXPECT_NEAR(glm::distance(hip, glm::vec3(0, 1, 0)), 0.0f, 1e-5f);
  EXPECT_EQ(found->poses[1].weight, 0.7f);
  EXPECT_THAT(found->notes, ElementsAre(HasSubstr("knee.extended is the rest pose"),
                                        HasSubstr("blink.value has no joint pose")));
}

// Where the joint `joint` of the skeleton moves the point `at`.
glm::vec3 Moved(const std::vector<glm::mat4>& matrices, int joint, const glm::vec3& at) {
  return matrices[static_cast<std::size_t>(joint)] * glm::vec4(at, 1.0f);
}

TEST(BakePoses, PosesAFeedAtItsFirstAngleOfFullWeight) {
  character::Character body = Body();
  body.rig.regions[0].feeds = {
      {"folds", {{"knee", "flexed"}}, {}, {}, {{10, 0}, {60, 1}, {80, 1}, {120, 0}}}};
  const std::string wanted[] = {"folds"};
  const auto found = CollectBakePoses(body, wanted);
  ASSERT_TRUE(found.ok()) << found.status().ToString();
  ASSERT_EQ(found->poses.size(), 1u);
  const glm::vec3 foot = Moved(found->poses[0].skin_matrices, 1, glm::vec3(0.0f));
  const float turn = 60.0f * kDegrees;
  EXPECT_NEAR(glm::distance(foot, 0.5f * glm::vec3(0, 1.0f - std::cos(turn), -std::sin(turn))),
              0.0f, 1e-5f);
}

// The path leads from the rest pose to the pose in equal steps, so that the knee bends evenly.
TEST(BakePoses, StateTheWayToThePoseInStepsOfAtMost8Degrees) {
  const auto found = CollectBakePoses(Body());
  ASSERT_TRUE(found.ok()) << found.status().ToString();
  const BakePose& knee = found->poses[0];
  ASSERT_EQ(knee.path.size(), 13u);  // 90 degrees in 12 steps of 7.5
  EXPECT_EQ(knee.path.back(), knee.skin_matrices);
  for (std::size_t k = 0; k < knee.path.size(); ++k) {
    const float turn = static_cast<float>(k) * 7.5f * kDegrees;
    const glm::vec3 foot = Moved(knee.path[k], 1, glm::vec3(0.0f));
    EXPECT_NEAR(glm::distance(foot, 0.5f * glm::vec3(0, 1.0f - std::cos(turn), -std::sin(turn))),
                0.0f, 1e-5f)
        << k;
  }
}

// Clothes cut for a bent knee: the path begins there, and a pose that does not bend the hip keeps
// the hip of that pose.
TEST(BakePoses, BeginTheWayAtThePoseThatTheClothesWereCutFor) {
  character::Character body = Body();
  const glm::quat knee = glm::angleAxis(45.0f * kDegrees, glm::vec3(1, 0, 0));
  const glm::quat hip = glm::angleAxis(10.0f * kDegrees, glm::vec3(0, 0, 1));
  body.rig.reference_poses.push_back({.name = std::string(wrinkle::kClothesFitPose),
                                      .joints = {{"knee", knee}, {"hip", hip}, {"tail", knee}}});
  const std::string wanted[] = {"folds"};
  const auto found = CollectBakePoses(body, wanted);
  ASSERT_TRUE(found.ok()) << found.status().ToString();
  const std::vector<std::vector<glm::mat4>>& path = found->poses[0].path;
  const glm::vec3 begin = Moved(path.front(), 1, glm::vec3(0.0f));
  const glm::vec3 end = Moved(path.back(), 1, glm::vec3(0.0f));
  const auto foot = [&](float degrees) {
    const float turn = degrees * kDegrees;
    return glm::vec3(0, 1, 0) +
           hip * (glm::vec3(0, -0.5f, 0) + 0.5f * glm::vec3(0, -std::cos(turn), -std::sin(turn)));
  };
  EXPECT_NEAR(glm::distance(begin, foot(45.0f)), 0.0f, 1e-5f);
  EXPECT_NEAR(glm::distance(end, foot(90.0f)), 0.0f, 1e-5f);
  EXPECT_EQ(path.size(), 7u);  // 45 degrees in 6 steps
}

// Slack cloth folds at a straight limb, towards whichever side it would bend.
TEST(BakePoses, AreOnePoseForAllStraightLimbs) {
  character::Character body = Body();
  body.rig.drivers.push_back(body.rig.drivers[0]);
  body.rig.drivers.back().name = "back";
  body.rig.drivers.back().hinge.axis = glm::vec3(-1, 0, 0);
  body.rig.regions[0].feeds = {
      {"folds", {{"knee", "flexed"}, {"back", "flexed", 0.9f}}, {}, {}, {{0, 1}, {40, 0}}}};
  const std::string wanted[] = {"folds"};
  const auto found = CollectBakePoses(body, wanted);
  ASSERT_TRUE(found.ok()) << found.status().ToString();
  ASSERT_EQ(found->poses.size(), 1u);
  EXPECT_EQ(found->poses[0].weight, 1.0f);
  const glm::vec3 foot = Moved(found->poses[0].skin_matrices, 1, glm::vec3(0.0f));
  EXPECT_NEAR(glm::length(foot), 0.0f, 1e-5f);
  EXPECT_THAT(found->notes, ElementsAre());
}

// A twist that reaches 1 at 60 degrees is posed there, when the hinge before it is at its end.
TEST(BakePoses, PoseOtherSourcesAtTheAngleOfTheSameValue) {
  character::Character body = Body();
  wrinkle::Driver twist;
  twist.name = "turn";
  twist.kind = wrinkle::Driver::Kind::kTwist;
  twist.twist.joint = "knee";
  twist.twist.axis = glm::vec3(0, 1, 0);
  twist.twist.full_degrees = 60.0f;
  body.rig.drivers.push_back(twist);
  body.rig.regions[0].feeds = {
      {"folds", {{"knee", "flexed"}, {"turn", "twist_left"}}, {}, {}, {{10, 0}, {90, 1}}}};
  const std::string wanted[] = {"folds"};
  const auto found = CollectBakePoses(body, wanted);
  ASSERT_TRUE(found.ok()) << found.status().ToString();
  ASSERT_EQ(found->poses.size(), 2u);
  const glm::mat3 turned(found->poses[1].skin_matrices[1]);
  EXPECT_NEAR(turned[0][0], std::cos(60.0f * kDegrees), 1e-3f);
}

// Two reference poses of blend shapes have the same joints.
TEST(BakePoses, PosesOfShapesAreDifferentPoses) {
  character::Character body = Body();
  body.shapes = {"mouthSmileLeft", "mouthPucker"};
  body.meshes.resize(1);
  body.meshes[0].vertices.resize(1);
  for (int shape = 0; shape < 2; ++shape) {
    body.meshes[0].morph_targets.push_back({.shape = shape});
  }
  body.rig.reference_poses = {{.name = "a", .shapes = {{"mouthSmileLeft", 1.0f}}},
                              {.name = "b", .shapes = {{"mouthPucker", 1.0f}}}};
  body.rig.drivers[1].pose.values = {{"one", "a"}, {"two", "b"}};
  body.rig.regions[1].feeds = {{"stretch", {{"brow", "one"}, {"brow", "two"}}}};
  const std::string wanted[] = {"stretch"};
  const auto found = CollectBakePoses(body, wanted);
  ASSERT_TRUE(found.ok()) << found.status().ToString();
  ASSERT_EQ(found->poses.size(), 2u);
  EXPECT_NE(found->poses[0].shape_weights, found->poses[1].shape_weights);
}

TEST(BakePoses, WeakSourcesOfAFeedWithAnglesShareTheFoldsOfTheStrongOnes) {
  character::Character body = Body();
  body.rig.regions[0].feeds = {
      {"folds", {{"knee", "flexed"}, {"knee", "extended", 0.5f}}, {}, {}, {{10, 0}, {60, 1}}}};
  const std::string wanted[] = {"folds"};
  const auto found = CollectBakePoses(body, wanted);
  ASSERT_TRUE(found.ok()) << found.status().ToString();
  EXPECT_EQ(found->poses.size(), 1u);
}

TEST(BakePoses, UsesOnlyTheRequestedMaps) {
  const std::string wanted[] = {"stretch"};
  const auto found = CollectBakePoses(Body(), wanted);
  ASSERT_TRUE(found.ok());
  ASSERT_EQ(found->poses.size(), 1u);
  EXPECT_EQ(found->poses[0].map, "stretch");
  const std::string unknown[] = {"squash"};
  const Status status = CollectBakePoses(Body(), unknown).status();
  EXPECT_EQ(status.code(), StatusCode::kNotFound);
  EXPECT_THAT(status.todo(), HasSubstr("folds, stretch"));
}

TEST(BakePoses, RejectsAReferencePoseEqualToRest) {
  character::Character body = Body();
  body.rig.reference_poses[0].joints[0].translation = glm::vec3(0.0f);
  const Status status = CollectBakePoses(body).status();
  EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
  EXPECT_THAT(status.what(), HasSubstr("'up' equals the rest pose"));
  EXPECT_EQ(status.where(), "regions[1].feeds[0].sources[0]");
}

TEST(BakePoses, ReportsMissingJointsAndRigs) {
  character::Character body = Body();
  body.rig.drivers[0].hinge.joint = "shin";
  EXPECT_THAT(CollectBakePoses(body).status().what(), HasSubstr("'shin'"));
  body = Body();
  body.rig.reference_poses[0].joints[0].joint = "eyebrow";
  EXPECT_EQ(CollectBakePoses(body).status().code(), StatusCode::kNotFound);
  EXPECT_EQ(CollectBakePoses(character::Character()).status().code(), StatusCode::kNotFound);
}

}  // namespace
}  // namespace furrow::authoring

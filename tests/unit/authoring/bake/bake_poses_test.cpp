// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/bake_poses.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
  rig.wrinkle_maps = {{.name = "folds"}, {.name = "stretch"}};
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

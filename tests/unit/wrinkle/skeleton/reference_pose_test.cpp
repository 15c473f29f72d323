// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/skeleton/reference_pose.h"

#include <gtest/gtest.h>

#include "tests/unit/wrinkle/test_characters.h"
#include "wrinkle/skeleton/pose.h"
#include "wrinkle/skeleton/retarget.h"

namespace furrow::wrinkle {
namespace {

Skeleton TurnedArm() {
  // The arm's rest frame is turned a quarter about Z: its local X points up in the model.
  Transform arm;
  arm.translation = {1.0f, 0.0f, 0.0f};
  arm.rotation = AngleAxis(90.0f, {0.0f, 0.0f, 1.0f});
  Transform hand;
  hand.translation = {2.0f, 0.0f, 0.0f};
  auto skeleton =
      Skeleton::Create({{"root", kNoJoint, Transform()}, {"arm", 0, arm}, {"hand", 1, hand}});
  EXPECT_TRUE(skeleton.ok());
  return *skeleton;
}

std::vector<glm::mat4> Model(const Skeleton& skeleton, const std::vector<Transform>& locals) {
  std::vector<glm::mat4> model(locals.size());
  EXPECT_EQ((LocalToModelJob{&skeleton, locals, model}.Run()), JobStatus::kOk);
  return model;
}

TEST(ReferencePose, TurnsAndMovesInModelAxes) {
  const Skeleton skeleton = TurnedArm();
  ReferencePose pose{"p", {{"arm", AngleAxis(90.0f, {1.0f, 0.0f, 0.0f}), {0.0f, 0.0f, 0.5f}}}, 0};
  std::vector<Transform> locals(skeleton.rest_pose().begin(), skeleton.rest_pose().end());
  ASSERT_TRUE(ApplyReferencePose(pose, skeleton, locals).ok());
  const auto model = Model(skeleton, locals);
  // At rest the hand is 2 above the arm; a quarter turn about the model's X brings it in front.
  const glm::vec3 hand = model[2][3];
  EXPECT_NEAR(hand.x, 1.0f, 1e-5f);
  EXPECT_NEAR(hand.y, 0.0f, 1e-5f);
  EXPECT_NEAR(hand.z, 2.5f, 1e-5f);
}

TEST(ReferencePose, LengthsFollowTheSizeOfTheSkeleton) {
  const Skeleton skeleton = TurnedArm();
  ReferencePose pose{"p", {{"hand", {1, 0, 0, 0}, {0.0f, 0.0f, 0.5f}}}, 0};
  pose.source_size = 0.5f * SkeletonSize(skeleton);
  std::vector<Transform> locals(skeleton.rest_pose().begin(), skeleton.rest_pose().end());
  ASSERT_TRUE(ApplyReferencePose(pose, skeleton, locals).ok());
  EXPECT_NEAR(Model(skeleton, locals)[2][3].z, 1.0f, 1e-5f);
}

TEST(ReferencePose, AnUnknownJointIsAnErrorAndChangesNothing) {
  const Skeleton skeleton = TurnedArm();
  ReferencePose pose{"p",
                     {{"arm", AngleAxis(20.0f, {1.0f, 0.0f, 0.0f}), glm::vec3(0.0f)},
                      {"tail", AngleAxis(20.0f, {1.0f, 0.0f, 0.0f}), glm::vec3(0.0f)}},
                     0};
  std::vector<Transform> locals(skeleton.rest_pose().begin(), skeleton.rest_pose().end());
  const Status status = ApplyReferencePose(pose, skeleton, locals);
  EXPECT_EQ(status.code(), StatusCode::kNotFound);
  EXPECT_NE(status.ToString().find("'tail'"), std::string::npos);
  EXPECT_EQ(locals[1].rotation, skeleton.rest_pose()[1].rotation);

  pose.joints[1].rotation = glm::quat(1, 0, 0, 0);  // a joint at rest need not be there
  EXPECT_TRUE(ApplyReferencePose(pose, skeleton, locals).ok());
}

}  // namespace
}  // namespace furrow::wrinkle

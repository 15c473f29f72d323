// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/skeleton/joint_chain.h"

#include <gtest/gtest.h>

#include "tests/unit/wrinkle/test_characters.h"

namespace furrow::wrinkle {
namespace {

// Every pair of joint and base, against model-space matrices.
TEST(JointChains, AgreeWithModelSpace) {
  std::mt19937 random(3);
  const Skeleton body = MakeBody(8);
  LocalPose pose;
  RandomPose(body, &random, &pose);
  pose.joints[body.Find("neck")].scale = glm::vec3(1.5f);
  std::vector<glm::mat4> model(pose.joints.size());
  ASSERT_EQ((LocalToModelJob{.skeleton = &body, .local = pose.joints, .model = model}).Run(),
            JobStatus::kOk);
  JointChains chains;
  for (int base = kNoJoint; base < body.num_joints(); ++base) {
    const glm::mat4 to_base = base == kNoJoint ? glm::mat4(1.0f) : glm::inverse(model[base]);
    for (int joint = 0; joint < body.num_joints(); ++joint) {
      const glm::vec3 offset = RandomVector(&random, 0.2f);
      const glm::vec3 expected(to_base * model[joint] * glm::vec4(offset, 1.0f));
      const int point = chains.Add(body, joint, offset, base);
      EXPECT_LT(glm::distance(chains.Evaluate(pose.joints, point), expected), 1e-5f)
          << joint << " seen from " << base;
    }
  }
}

TEST(JointChains, ReachAcrossTrees) {
  const Skeleton two =
      MakeSkeleton({{"a", "", {1, 0, 0}, {}}, {"b", "", {0, 2, 0}, {}}, {"c", "b", {0, 3, 0}, {}}});
  JointChains chains;
  const int point = chains.Add(two, two.Find("c"), glm::vec3(0.0f), two.Find("a"));
  EXPECT_LT(glm::distance(chains.Evaluate(two.rest_pose(), point), glm::vec3(-1, 3, 0)), 1e-6f);
}

TEST(JointChains, DoNotPassThroughTheRoot) {
  const Skeleton body = MakeBody();
  JointChains chains;
  const int point = chains.Add(body, body.Find("brow_l"), glm::vec3(0.01f), body.Find("head"));
  LocalPose pose = RestPose(body);
  const glm::vec3 before = chains.Evaluate(pose.joints, point);
  pose.joints[0].translation += glm::vec3(4321.0f, 7.0f, -9876.5f);
  pose.joints[0].rotation = AngleAxis(123.0f, {1, 2, 3});
  EXPECT_EQ(chains.Evaluate(pose.joints, point), before);
}

}  // namespace
}  // namespace furrow::wrinkle

// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "authoring/generator/body/body_skeleton.h"
#include "rig/rig_file.h"
#include "wrinkle/shapes/blend_shape_pose.h"
#include "wrinkle/skeleton/reference_pose.h"
#include "wrinkle/solver/solver.h"

namespace furrow::authoring {
namespace {

std::vector<std::string> ArkitNames() {
  std::vector<std::string> names = {
      "jawForward",      "jawLeft",        "jawRight",       "jawOpen",
      "mouthClose",      "mouthFunnel",    "mouthPucker",    "mouthLeft",
      "mouthRight",      "mouthRollLower", "mouthRollUpper", "mouthShrugLower",
      "mouthShrugUpper", "browInnerUp",    "cheekPuff",      "tongueOut"};
  for (const char* both :
       {"eyeBlink", "eyeLookDown", "eyeLookIn", "eyeLookOut", "eyeLookUp", "eyeSquint", "eyeWide",
        "mouthSmile", "mouthFrown", "mouthDimple", "mouthStretch", "mouthPress", "mouthLowerDown",
        "mouthUpperUp", "browDown", "browOuterUp", "cheekSquint", "noseSneer"}) {
    names.push_back(std::string(both) + "Left");
    names.push_back(std::string(both) + "Right");
  }
  return names;
}

class ArkitPoseTest : public ::testing::Test {
 protected:
  static wrinkle::Rig LoadDefault() {
    Result<wrinkle::Rig> rig =
        rig::LoadRig(std::filesystem::path(FURROW_SOURCE_DIR) / "rig/rigs/default.json");
    EXPECT_TRUE(rig.ok()) << rig.status().ToString();
    return rig.ok() ? std::move(rig).value() : wrinkle::Rig();
  }

  // Model-space origins of all joints with blend shape `name` at 1.
  std::vector<glm::vec3> Posed(const std::string& name) const {
    const wrinkle::BlendShapePose pose =
        wrinkle::BlendShapePose::Create(rig_, skeleton_, std::vector<std::string>{name});
    std::vector<wrinkle::Transform> local(skeleton_.rest_pose().begin(),
                                          skeleton_.rest_pose().end());
    EXPECT_EQ(pose.Run(std::vector<float>{1.0f}, local), wrinkle::JobStatus::kOk);
    std::vector<glm::mat4> model(local.size());
    EXPECT_EQ((wrinkle::LocalToModelJob{&skeleton_, local, model}.Run()), wrinkle::JobStatus::kOk);
    std::vector<glm::vec3> origins;
    for (const glm::mat4& matrix : model) origins.emplace_back(matrix[3]);
    return origins;
  }

  glm::vec3 Moved(const std::string& shape, const std::string& joint) const {
    const int index = skeleton_.Find(joint);
    return Posed(shape)[index] - glm::vec3(skeleton_.rest_model()[index][3]);
  }

  wrinkle::Rig rig_ = LoadDefault();
  wrinkle::Skeleton skeleton_ = MakeSkeleton();
};

TEST_F(ArkitPoseTest, EachOfThe52MovesTheFace) {
  const std::vector<std::string> names = ArkitNames();
  ASSERT_EQ(names.size(), 52u);
  for (const std::string& name : names) {
    const auto pose = std::find_if(rig_.reference_poses.begin(), rig_.reference_poses.end(),
                                   [&](const auto& p) { return p.name == name; });
    ASSERT_NE(pose, rig_.reference_poses.end()) << name;
    const bool moves = std::any_of(pose->joints.begin(), pose->joints.end(),
                                   [](const auto& delta) { return !wrinkle::IsRest(delta); });
    EXPECT_TRUE(moves) << name;
  }
}

TEST_F(ArkitPoseTest, LeftIsTheSubjectsLeft) {
  for (const std::string& name : ArkitNames()) {
    if (name.starts_with("jaw") || name == "mouthLeft" || name == "mouthRight") continue;
    const bool left = name.ends_with("Left"), right = name.ends_with("Right");
    if (!left && !right) continue;
    const auto pose = std::find_if(rig_.reference_poses.begin(), rig_.reference_poses.end(),
                                   [&](const auto& p) { return p.name == name; });
    for (const wrinkle::JointDelta& delta : pose->joints) {
      EXPECT_TRUE(delta.joint.ends_with(left ? "_l" : "_r")) << name << " moves " << delta.joint;
    }
  }
  EXPECT_GT(Moved("jawLeft", "mentalis").x, 0.004f);
  EXPECT_LT(Moved("jawLeft", "jaw").x, 0.002f) << "the jaw turns; its corners stay below the ears";
  EXPECT_GT(Moved("mouthLeft", "risorius_l").x, 0.004f);
}

TEST_F(ArkitPoseTest, ShapesMoveInTheNamedDirections) {
  EXPECT_LT(Moved("jawOpen", "orbicularis_oris_lower_l").y, -0.015f);
  EXPECT_GT(Moved("mouthSmileLeft", "risorius_l").y, 0.005f);
  EXPECT_LT(Moved("mouthFrownRight", "risorius_r").y, -0.005f);
  EXPECT_GT(Moved("mouthFunnel", "orbicularis_oris_upper_l").z, 0.004f);
  EXPECT_GT(Moved("browInnerUp", "frontalis_inner_r").y, 0.005f);
  EXPECT_LT(Moved("browDownLeft", "corrugator_l").y, -0.002f);
  // mouthClose raises the lower lip as far as jawOpen lowers it.
  const float open = Moved("jawOpen", "orbicularis_oris_lower_l").y;
  const float close = Moved("mouthClose", "orbicularis_oris_lower_l").y -
                      Moved("mouthClose", "orbicularis_oris_upper_l").y;
  EXPECT_NEAR(open + close, 0.0f, 0.012f);
}

// A tracker's stream without joints wrinkles the face. A stream of joints without blend shapes
// binds in strict mode.
TEST_F(ArkitPoseTest, CoefficientsWrinkleTheFace) {
  const std::vector<std::string> names = ArkitNames();
  auto binding =
      wrinkle::RigBinding::Create(rig_, wrinkle::Skeleton(), names, {.allow_missing = true});
  ASSERT_TRUE(binding.ok()) << binding.status().ToString();
  EXPECT_TRUE(binding->missing_blend_shapes().empty());
  wrinkle::SubjectSolver solver(
      std::make_shared<const wrinkle::RigBinding>(std::move(binding).value()), false);
  const auto weight = [&](const std::string& shape, const std::string& name) {
    wrinkle::LocalPose pose;
    for (const std::string& other : names)
      pose.blend_shapes.push_back(other == shape ? 1.0f : 0.0f);
    EXPECT_EQ(solver.Update(pose, 1.0 / 60.0), wrinkle::JobStatus::kOk);
    const auto all = solver.binding().weight_names();
    const auto found = std::find(all.begin(), all.end(), name);
    EXPECT_NE(found, all.end()) << name;
    return found == all.end() ? -1.0f : solver.wrinkle_weights()[found - all.begin()];
  };
  EXPECT_GT(weight("mouthSmileLeft", "mouth_l.squash"), 0.9f);
  EXPECT_LT(weight("mouthSmileLeft", "mouth_r.squash"), 0.05f);
  EXPECT_GT(weight("browInnerUp", "brow_r.stretch"), 0.9f);
  EXPECT_GT(weight("browDownRight", "brow_r.squash"), 0.9f);
  EXPECT_GT(weight("noseSneerLeft", "nose.squash"), 0.4f);
  EXPECT_LT(weight("jawLeft", "mouth_l.stretch"), 0.05f);

  EXPECT_TRUE(wrinkle::RigBinding::Create(rig_, skeleton_, {}, {}).ok());
}

}  // namespace
}  // namespace furrow::authoring

// SPDX-License-Identifier: Apache-2.0
#include "character/package/rig_report.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "authoring/generator/body/body_skeleton.h"
#include "motion/clip/clip.h"
#include "motion/clip_file.h"
#include "rig/rig_file.h"
#include "wrinkle/solver/solver.h"

namespace furrow::character {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

wrinkle::Rig Shipped(const char* name) {
  return *rig::LoadRig(std::string(FURROW_SOURCE_DIR "/rig/rigs/") + name);
}

TEST(RigReport, CountsAndNames) {
  const RigReport report = ReportOnRig(Shipped("cmu.json"));
  EXPECT_THAT(report.counts, Contains(std::make_pair(std::string("drivers"), std::size_t{11})));
  EXPECT_THAT(report.weight_names, Contains("knee_l_inner.folds"));
  EXPECT_THAT(report.driver_value_names, Contains("waist.front"));
  EXPECT_THAT(report.warnings, IsEmpty());
  EXPECT_TRUE(report.binding.ok());
  EXPECT_THAT(ToText(report), HasSubstr("22 wrinkle weights"));
}

TEST(RigReport, EveryDriverOfArkitFeedsARegion) {
  const std::string embedded[] = {"face_masks_a", "face_masks_b", "face_stretch", "face_squash"};
  RigReportOptions options;
  options.embedded_pictures = embedded;
  const RigReport report = ReportOnRig(Shipped("arkit.json"), options);
  EXPECT_THAT(report.counts, Contains(std::make_pair(std::string("drivers"), std::size_t{48})));
  EXPECT_EQ(report.weight_names.size(), 16u);
  EXPECT_THAT(report.warnings, IsEmpty());
  EXPECT_THAT(ReportOnRig(Shipped("arkit.json")).warnings,
              Contains(HasSubstr("picture 'face_masks_a'")));
}

TEST(RigReport, WarnsOfUnusedPartsAndMissingReferences) {
  const auto rig = rig::ParseRig(R"({"name": "r", "reference_poses": [
      {"name": "used", "joints": [{"joint": "other", "euler_degrees": [9, 0, 0]}]},
      {"name": "unused", "joints": []},
      {"name": "clothes_fit", "joints": [{"joint": "other", "euler_degrees": [0, 0, 30]}]}],
    "drivers": [{"name": "d", "pose": {"points": [{"joint": "tip"}],
                                       "values": [{"name": "v", "reference_pose": "used"}]}},
                {"name": "idle", "blend_shape": {"blend_shape": "jawOpen"}}],
    "regions": [{"name": "a", "mask": {"texture": "m.png"},
                 "feeds": [{"map": "m", "sources": [{"from": "d.v"}]}]}],
    "wrinkle_maps": [{"name": "m"}, {"name": "spare"}]})",
                                 "r", ".");
  ASSERT_TRUE(rig.ok()) << rig.status().ToString();
  const auto skeleton = *wrinkle::Skeleton::Create({{"root", -1, {}, {}},
                                                    {"tip", 0, {glm::vec3(0, 1, 0)}, {}},
                                                    {"other", 0, {glm::vec3(1, 0, 0)}, {}}});
  RigReportOptions options;
  options.skeleton = &skeleton;
  const RigReport report = ReportOnRig(*rig, options);
  EXPECT_THAT(report.warnings, Contains("no driver uses reference pose 'unused'"));
  EXPECT_THAT(report.warnings, Not(Contains(HasSubstr("clothes_fit")))) << "the bake uses it";
  EXPECT_THAT(report.warnings, Contains("driver 'idle' feeds no region"));
  EXPECT_THAT(report.warnings, Contains("no region uses wrinkle map 'spare'"));
  EXPECT_THAT(report.warnings, Contains(HasSubstr("value 'v' stays 0")));
  EXPECT_THAT(report.warnings, Contains(HasSubstr("picture 'm.png'")));
  // A rig that reads joints binds to a skeleton without any blend shapes.
  EXPECT_TRUE(report.binding.ok()) << report.binding.ToString();
  EXPECT_THAT(report.warnings, Contains("no blend shape 'jawOpen' comes with the skeleton"));
  EXPECT_GT(report.skeleton_size, 0.0f);
  const std::string others[] = {"eyeBlinkLeft"};
  options.blend_shape_names = others;
  EXPECT_FALSE(ReportOnRig(*rig, options).binding.ok())
      << "the rig needs a blend shape that the list lacks";
}

TEST(RigReport, WarnsOfFacesWithoutAnAnchor) {
  wrinkle::Rig rig = Shipped("default.json");
  EXPECT_THAT(ReportOnRig(rig).warnings, Not(Contains(HasSubstr("measured in model space"))));
  rig.anchor.clear();
  EXPECT_THAT(ReportOnRig(rig).warnings, Contains(HasSubstr("more are measured in model space")));
  RigReportOptions options;
  const wrinkle::Skeleton skeleton = authoring::MakeSkeleton();
  options.skeleton = &skeleton;
  EXPECT_THAT(ReportOnRig(rig, options).warnings,
              Contains(HasSubstr("more are measured in model space")));
}

// An axis along +Z is across a leg, but not across the leg of a Z-up skeleton.
TEST(RigReport, BindsToTheTurnedSkeleton) {
  wrinkle::Rig rig;
  rig.drivers.resize(1);
  rig.drivers[0].name = "knee";
  rig.drivers[0].kind = wrinkle::Driver::Kind::kHinge;
  rig.drivers[0].hinge = {
      .parent = "upper_leg_l", .joint = "lower_leg_l", .end = "foot_l", .axis = glm::vec3(0, 0, 1)};
  const glm::quat turn = glm::angleAxis(glm::radians(90.0f), glm::vec3(1, 0, 0));
  const wrinkle::Skeleton z_up = wrinkle::TurnRoots(authoring::MakeSkeleton(), turn);
  RigReportOptions options;
  options.skeleton = &z_up;
  EXPECT_FALSE(ReportOnRig(rig, options).binding.ok());
  options.turn = glm::conjugate(turn);
  const RigReport report = ReportOnRig(rig, options);
  EXPECT_TRUE(report.binding.ok()) << report.binding.ToString();
}

TEST(RigReport, CmuFollowsKneesAndElbowsOfARecording) {
  const std::string path = FURROW_SHARED_DATA "/cmu/01_01.bvh";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is missing";
  const auto clip = motion::LoadClip(path);
  ASSERT_TRUE(clip.ok()) << clip.status().ToString();
  const wrinkle::Rig rig = Shipped("cmu.json");
  auto binding = wrinkle::RigBinding::Create(rig, clip->skeleton, {});
  ASSERT_TRUE(binding.ok()) << binding.status().ToString();
  const auto shared = std::make_shared<const wrinkle::RigBinding>(std::move(*binding));
  wrinkle::SubjectSolver solver(shared, false);
  const auto index = [&](const char* name) {
    const auto names = shared->driver_value_names();
    return std::find(names.begin(), names.end(), name) - names.begin();
  };
  struct Hinge {
    const char* value;
    const char* upper;
    const char* joint;
    const char* end;
  };
  const Hinge hinges[] = {{"knee_l.flexed", "LeftUpLeg", "LeftLeg", "LeftFoot"},
                          {"knee_r.flexed", "RightUpLeg", "RightLeg", "RightFoot"},
                          {"elbow_l.flexed", "LeftArm", "LeftForeArm", "LeftHand"},
                          {"elbow_r.flexed", "RightArm", "RightForeArm", "RightHand"}};
  wrinkle::LocalPose pose;
  std::vector<glm::mat4> model(static_cast<std::size_t>(clip->skeleton.num_joints()));
  float most = 0.0f;
  for (int frame = 0; frame < clip->num_frames(); frame += 32) {
    clip->GetPose(frame, &pose);
    ASSERT_EQ(solver.Update(pose, 1.0 / 120), wrinkle::JobStatus::kOk);
    const wrinkle::LocalToModelJob job{&clip->skeleton, pose.joints, model};
    ASSERT_EQ(job.Run(), wrinkle::JobStatus::kOk);
    for (const Hinge& hinge : hinges) {
      const auto at = [&](const char* joint) {
        return glm::vec3(model[static_cast<std::size_t>(clip->skeleton.Find(joint))][3]);
      };
      const float cosine = glm::dot(glm::normalize(at(hinge.joint) - at(hinge.upper)),
                                    glm::normalize(at(hinge.end) - at(hinge.joint)));
      const float beta = hinge.value[0] == 'k' ? 30.0f : 35.0f;
      const float due = std::min(1.0f, (1.0f - cosine) / (1.0f + std::cos(glm::radians(beta))));
      const float value = solver.driver_values()[static_cast<std::size_t>(index(hinge.value))];
      EXPECT_NEAR(value, due, 2e-3f) << hinge.value << " in frame " << frame;
      most = std::max(most, value);
    }
  }
  EXPECT_GT(most, 0.9f) << "an elbow bends to 138 degrees in this clip";
}

}  // namespace
}  // namespace furrow::character

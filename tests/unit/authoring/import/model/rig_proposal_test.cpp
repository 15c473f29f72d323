// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/model/rig_proposal.h"

#include <algorithm>
#include <string>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "authoring/import/model/character_space.h"
#include "motion/clip/clip.h"
#include "motion/clip_file.h"
#include "rig/rig_check.h"
#include "rig/rig_file.h"
#include "tests/unit/authoring/import/model/toy_body.h"
#include "wrinkle/solver/solver.h"

namespace furrow::authoring {
namespace {

using wrinkle::JointRole;

rig::SkeletonMaps Map(const std::string& name) {
  return *rig::SkeletonMaps::Load(std::string(FURROW_SOURCE_DIR) + "/rig/skeleton_maps/" + name +
                                  ".json");
}

// The template rig of these tests, made for the body of boxes.
wrinkle::Rig ToyRig() {
  const char* kText = R"({"version": 1, "name": "toy", "drivers": [
    {"name": "knee_l", "hinge": {"parent": "leftUpperLeg", "joint": "leftLowerLeg",
                                 "end": "leftFoot", "axis": [1, 0, 0]}},
    {"name": "elbow_r", "hinge": {"parent": "rightUpperArm", "joint": "rightLowerArm",
                                  "end": "rightHand", "axis": [0, 1, 0], "beta_degrees": 35}},
    {"name": "hip_l", "ball": {"parent": "hips", "joint": "leftUpperLeg", "end": "leftLowerLeg",
                               "bone": [0, -1, 0], "beta_degrees": 60}},
    {"name": "neck", "twist": {"joint": "neck", "through": ["head"], "axis": [0, 1, 0]}}],
   "regions": [
    {"name": "knee", "mask": {"kind": "skinning"}, "neighbours": ["elbow"],
     "feeds": [{"map": "folds", "sources": [{"from": "knee_l.flexed"}]}]},
    {"name": "elbow", "mask": {"texture": "painted", "channel": "r"},
     "feeds": [{"map": "folds", "sources": [{"from": "elbow_r.flexed"}]}]}],
   "wrinkle_maps": [{"name": "folds", "normal": "folds"}]})";
  return *rig::ParseRig(kText, "toy", ".");
}

const wrinkle::Driver* Find(const wrinkle::Rig& rig, const std::string& name) {
  const auto found = std::find_if(rig.drivers.begin(), rig.drivers.end(),
                                  [&](const auto& driver) { return driver.name == name; });
  return found == rig.drivers.end() ? nullptr : &*found;
}

class CmuProposal : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto clip = motion::LoadClip(std::string(FURROW_SHARED_DATA) + "/cmu/01_01.bvh");
    if (!clip.ok()) GTEST_SKIP() << "the CMU recording is missing";
    skeleton_ = clip->skeleton;
    joints_ = FindJoints(skeleton_, Map("cmu"));
    const character::Character body = ToyBody();
    const FoundJoints body_joints = FindJoints(body.skeleton, Map("vrm"));
    const auto proposal =
        ProposeRig(ToyRig(), {&body.skeleton, &body_joints}, {&skeleton_, &joints_});
    ASSERT_TRUE(proposal.ok()) << proposal.status().ToString();
    rig_ = proposal->rig;
  }

  wrinkle::Skeleton skeleton_;
  FoundJoints joints_;
  wrinkle::Rig rig_;
};

// The proposed axes must equal those in the shipped rig cmu.json, which were chosen by hand from
// the recordings.
TEST_F(CmuProposal, HingesTurnAboutTheAxesOfTheShippedRig) {
  const wrinkle::Driver* knee = Find(rig_, "knee_l");
  ASSERT_NE(knee, nullptr);
  EXPECT_EQ(knee->hinge.parent, "LeftUpLeg");
  EXPECT_EQ(knee->hinge.joint, "LeftLeg");
  EXPECT_EQ(knee->hinge.end, "LeftFoot");
  EXPECT_LT(glm::distance(*knee->hinge.axis, glm::vec3(0.93969f, 0.34202f, 0.0f)), 1e-3f);
  const wrinkle::Driver* elbow = Find(rig_, "elbow_r");
  ASSERT_NE(elbow, nullptr);
  EXPECT_LT(glm::distance(*elbow->hinge.axis, glm::vec3(0.0f, 0.86603f, -0.5f)), 1e-3f);
  EXPECT_EQ(elbow->hinge.beta_degrees, 35.0f);
}

TEST_F(CmuProposal, BindsStrictlyAndChecks) {
  EXPECT_TRUE(rig::CheckRig(rig_).ok()) << rig::CheckRig(rig_).ToString();
  const auto binding = wrinkle::RigBinding::Create(rig_, skeleton_, {});
  EXPECT_TRUE(binding.ok()) << binding.status().ToString();
  EXPECT_EQ(rig_.anchor, "Head");
}

TEST_F(CmuProposal, TwistIncludesTheWholeNeck) {
  const wrinkle::Driver* neck = Find(rig_, "neck");
  ASSERT_NE(neck, nullptr);
  EXPECT_EQ(neck->twist.joint, "Neck");
  EXPECT_EQ(neck->twist.through, (std::vector<std::string>{"Neck1", "Head"}));
}

TEST_F(CmuProposal, UsesSkinningMasksAndMapsWithoutPictures) {
  for (const wrinkle::Region& region : rig_.regions) {
    EXPECT_EQ(region.mask.kind, wrinkle::Mask::Kind::kSkinning);
  }
  ASSERT_EQ(rig_.wrinkle_maps.size(), 1u);
  EXPECT_TRUE(rig_.wrinkle_maps[0].normal.empty());
}

TEST(RigProposal, OmitsPartsWithoutJointsAndTheirReferences) {
  const character::Character body = ToyBody();
  const FoundJoints body_joints = FindJoints(body.skeleton, Map("vrm"));
  // A bust has no legs.
  std::vector<wrinkle::JointDesc> descs;
  for (const char* name :
       {"hips", "spine", "chest", "neck", "head", "rightUpperArm", "rightLowerArm", "rightHand"}) {
    const int joint = body.skeleton.Find(name);
    const int parent = descs.empty()                          ? -1
                       : name == std::string("rightUpperArm") ? 2
                                                              : static_cast<int>(descs.size()) - 1;
    descs.push_back({name, parent, body.skeleton.rest_pose()[joint], {}});
  }
  const auto bust = *wrinkle::Skeleton::Create(descs);
  const FoundJoints bust_joints = FindJoints(bust, Map("vrm"));
  const auto proposal = ProposeRig(ToyRig(), {&body.skeleton, &body_joints}, {&bust, &bust_joints});
  ASSERT_TRUE(proposal.ok()) << proposal.status().ToString();
  EXPECT_EQ(Find(proposal->rig, "knee_l"), nullptr);
  EXPECT_NE(Find(proposal->rig, "elbow_r"), nullptr);
  ASSERT_EQ(proposal->rig.regions.size(), 1u);
  EXPECT_EQ(proposal->rig.regions[0].name, "elbow");
  EXPECT_TRUE(rig::CheckRig(proposal->rig).ok());
}

TEST(RigProposal, UnknownSkeletonIsNotFound) {
  const character::Character body = ToyBody();
  const FoundJoints body_joints = FindJoints(body.skeleton, Map("vrm"));
  const auto rope = *wrinkle::Skeleton::Create(
      {{"a", -1, {}, {}}, {"b", 0, {glm::vec3(0, 1, 0)}, {}}, {"c", 1, {glm::vec3(0, 1, 0)}, {}}});
  const FoundJoints none = FindJoints(rope, Map("vrm"));
  const auto proposal = ProposeRig(ToyRig(), {&body.skeleton, &body_joints}, {&rope, &none});
  EXPECT_EQ(proposal.status().code(), StatusCode::kNotFound);
}

// A turned body of boxes with unknown joint names. Its roles come only from its shape.
class Hierarchy : public ::testing::TestWithParam<glm::vec3> {};

TEST_P(Hierarchy, GivesTheSameRolesAsTheNames) {
  character::Character body = ToyBody();
  const FoundJoints by_name = FindJoints(body.skeleton, Map("vrm"));
  ASSERT_EQ(by_name.map, "vrm");
  const glm::vec3 angles = GetParam();
  const glm::mat3 turn(glm::mat3_cast(glm::quat(angles)));
  ASSERT_TRUE(MoveToSpace(turn, 3.0f, &body).ok());
  std::vector<wrinkle::JointDesc> descs;
  for (int j = 0; j < body.skeleton.num_joints(); ++j) {
    descs.push_back({"bone" + std::to_string(j), body.skeleton.joint_parents()[j],
                     body.skeleton.rest_pose()[j], body.skeleton.tails()[j]});
  }
  const FoundJoints found = FindJoints(*wrinkle::Skeleton::Create(descs), rig::SkeletonMaps());
  EXPECT_TRUE(found.map.empty());
  for (int j = 0; j < body.skeleton.num_joints(); ++j) {
    EXPECT_EQ(wrinkle::ToString(found.roles[j]), wrinkle::ToString(by_name.roles[j]))
        << body.skeleton.joint_names()[j];
  }
}

INSTANTIATE_TEST_SUITE_P(Turns, Hierarchy,
                         ::testing::Values(glm::vec3(0.0f), glm::vec3(1.57f, 0.0f, 0.0f),
                                           glm::vec3(0.0f, 2.5f, 0.0f),
                                           glm::vec3(0.4f, -1.2f, 2.0f)));

}  // namespace
}  // namespace furrow::authoring

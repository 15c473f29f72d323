// SPDX-License-Identifier: Apache-2.0
#include "rig/skeleton_fit.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/rig/shipped_matcher.h"

namespace furrow::rig {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using enum wrinkle::JointRole;

struct Part {
  const char* name;
  int parent;
  wrinkle::JointRole role;
};

// A body with its roles, whose joints lie in a line.
struct FitBody {
  explicit FitBody(const std::vector<Part>& parts) {
    std::vector<wrinkle::JointDesc> joints;
    for (const Part& part : parts) {
      wrinkle::JointDesc& joint = joints.emplace_back();
      joint.name = part.name;
      joint.parent = part.parent;
      joint.rest.translation = {0.0f, 0.1f, 0.0f};
      roles.roles.push_back(part.role);
      roles.num_joints += part.role != kNone ? 1 : 0;
    }
    roles.map = "mine";
    roles.num_roles = roles.num_joints;
    skeleton = *wrinkle::Skeleton::Create(std::move(joints));
  }
  [[nodiscard]] SkeletonFit Fit() const { return FitOf(roles, skeleton); }
  [[nodiscard]] std::vector<std::string> Warnings() const { return WarningsOf(Fit(), roles); }

  SkeletonRoles roles;
  wrinkle::Skeleton skeleton;
};

// The joints from the scene's root to the ends of hands and feet, each at its index.
std::vector<Part> WholeBody() {
  return {{"scene", -1, kNone},
          {"hips", 0, kHips},
          {"spine", 1, kSpine},
          {"head", 2, kHead},
          {"hair", 3, kNone},
          {"hair_end", 4, kNone},
          {"arm_l", 2, kLeftUpperArm},
          {"elbow_l", 6, kLeftLowerArm},
          {"twist_l", 7, kNone},
          {"hand_l", 7, kLeftHand},
          {"finger_l", 9, kNone},
          {"finger_end_l", 10, kNone},
          {"arm_r", 2, kRightUpperArm},
          {"elbow_r", 12, kRightLowerArm},
          {"hand_r", 13, kRightHand},
          {"leg_l", 1, kLeftUpperLeg},
          {"knee_l", 15, kLeftLowerLeg},
          {"foot_l", 16, kLeftFoot},
          {"leg_r", 1, kRightUpperLeg},
          {"knee_r", 18, kRightLowerLeg},
          {"foot_r", 19, kRightFoot}};
}

TEST(SkeletonFit, HairFingersTwistsAndTheSceneAreNotLeftOut) {
  const FitBody body(WholeBody());
  const SkeletonFit fit = body.Fit();
  EXPECT_EQ(fit.num_joints, 21);
  EXPECT_EQ(fit.num_explained, 15);
  EXPECT_THAT(fit.left_out, IsEmpty());
  EXPECT_THAT(fit.missing, IsEmpty());
  EXPECT_THAT(body.Warnings(), IsEmpty());
  EXPECT_EQ(Describe(body.roles), "skeleton map 'mine': 15 roles, 15 of 21 joints");
}

TEST(SkeletonFit, AMapWithoutArmsIsWarnedOf) {
  std::vector<Part> parts = WholeBody();
  for (const std::size_t arm : {6u, 7u, 9u, 12u, 13u, 14u}) parts[arm].role = kNone;
  const FitBody body(parts);
  EXPECT_THAT(body.Fit().left_out,
              ElementsAre("arm_l", "elbow_l", "hand_l", "finger_l", "arm_r", "elbow_r"));
  EXPECT_THAT(
      body.Warnings(),
      ElementsAre(AllOf(
          HasSubstr("skeleton map 'mine' gives no role to 6 joints of trunk and limbs (arm_l, "
                    "elbow_l, hand_l, finger_l, ...)"),
          HasSubstr("missing: leftUpperArm, leftLowerArm, rightUpperArm, rightLowerArm;"),
          HasSubstr("'furrow rig propose-map'"))));
}

// Nothing could have the missing roles, so the map is not at fault.
TEST(SkeletonFit, ARecordingWithoutLegsIsNoFault) {
  std::vector<Part> parts = WholeBody();
  parts.resize(15);
  const FitBody body(parts);
  EXPECT_THAT(body.Fit().missing,
              ElementsAre(kLeftUpperLeg, kLeftLowerLeg, kRightUpperLeg, kRightLowerLeg));
  EXPECT_THAT(body.Warnings(), IsEmpty());
}

TEST(SkeletonFit, AStiffSpineIsWarnedOf) {
  std::vector<Part> parts = {{"hips", -1, kHips}};
  for (int i = 0; i < 5; ++i) parts.push_back({nullptr, i, kNone});
  const char* names[] = {"", "s1", "s2", "s3", "s4", "s5"};
  for (std::size_t i = 1; i < parts.size(); ++i) parts[i].name = names[i];
  const int chest = 5;
  for (const Part& part : WholeBody()) {
    if (part.role == kNone || part.role == kHips || part.role == kSpine) continue;
    parts.push_back({part.name, chest, part.role});
  }
  EXPECT_EQ(FitBody(parts).Fit().num_between, 5);
  EXPECT_THAT(FitBody(parts).Warnings(),
              ElementsAre(HasSubstr("(s1, s2, s3, s4, ...), which move")));
  parts[1].role = parts[2].role = kSpine;
  EXPECT_THAT(FitBody(parts).Warnings(), IsEmpty());
}

// In a .vrma file, the human bones have VRM's names, and other joints their own.
TEST(SkeletonFit, HelpersBetweenTheBonesOfVrmAreNoFault) {
  std::vector<Part> parts = {{"hips", -1, kHips}};
  const char* names[] = {"Bone.001", "Bone.002", "Bone.003", "Bone.004", "Bone.005"};
  for (const char* name : names) {
    parts.push_back({name, static_cast<int>(parts.size()) - 1, kNone});
  }
  const int chest = static_cast<int>(parts.size()) - 1;
  for (const Part& part : WholeBody()) {
    if (part.role == kNone || part.role == kHips || part.role == kSpine) continue;
    parts.push_back({part.name, chest, part.role});
  }
  FitBody body(parts);
  EXPECT_THAT(body.Warnings(), ElementsAre(HasSubstr("move stiffly")));
  body.roles.map = "vrm";
  EXPECT_THAT(body.Warnings(), IsEmpty());
  parts.back().role = parts[parts.size() - 2].role = parts[parts.size() - 3].role = kNone;
  FitBody lame(parts);
  lame.roles.map = "vrm";
  EXPECT_THAT(lame.Warnings(), ElementsAre(HasSubstr("missing: rightUpperLeg, rightLowerLeg")));
}

TEST(SkeletonFit, AMapThatKnowsNothingIsWarnedOf) {
  std::vector<Part> parts = WholeBody();
  for (Part& part : parts) part.role = kNone;
  EXPECT_THAT(FitBody(parts).Warnings(), ElementsAre(HasSubstr("knows none of the 21 joints")));
}

TEST(SkeletonFit, GuessesAndPackagesAreNamed) {
  FitBody body(WholeBody());
  body.roles.map = kFromPackage;
  EXPECT_EQ(Describe(body.roles),
            "joint roles of the character's package: 15 roles, 15 of 21 joints");
  body.roles.map = kFromHierarchy;
  EXPECT_EQ(Describe(body.roles),
            "no skeleton map fits; guessed from the hierarchy: 15 roles, 15 of 21 joints");
  body.roles = {};
  EXPECT_EQ(Describe(body.roles), "");
  EXPECT_THAT(body.Warnings(), IsEmpty());
}

// A match says so in any case, since the daemon and all commands print it.
TEST(SkeletonFit, AMatchNamesTheShareAndUnknownSkeletons) {
  const auto matcher = ShippedMatcher();
  ASSERT_TRUE(matcher.ok()) << matcher.status().ToString();
  const FitBody unknown({{"box", -1, kNone}, {"lid", 0, kNone}});
  const SkeletonMatch none = matcher->Match(unknown.skeleton, wrinkle::Rig(), nullptr);
  EXPECT_EQ(Describe(none),
            "no skeleton map fits, so joints are matched by equal names (--skeleton-map chooses "
            "one)");
  EXPECT_EQ(Describe(matcher->Match(wrinkle::Skeleton(), wrinkle::Rig(), nullptr)), "");

  // Furrow's own names, and too few of them for a map.
  const FitBody face({{"head", -1, kNone}, {"jaw", 0, kNone}, {"brow_l", 0, kNone}});
  EXPECT_EQ(Describe(matcher->Match(face.skeleton, wrinkle::Rig(), nullptr)),
            "no skeleton map fits (the best finds 2 roles of the 6 that it needs), so joints are "
            "matched by equal names (--skeleton-map chooses one)");
  EXPECT_EQ(Describe(matcher->Match(face.skeleton, wrinkle::Rig(), &face.skeleton)),
            "joints are matched by equal names: 3 of 3 joints");
  const FitBody more({{"head", -1, kNone}, {"jaw", 0, kNone}, {"ear", 0, kNone}});
  EXPECT_EQ(Describe(matcher->Match(more.skeleton, wrinkle::Rig(), &face.skeleton)),
            "joints are matched by equal names: 2 of 3 joints; no skeleton map fits the others "
            "(--skeleton-map chooses one)");

  const FitBody trunk({{"Hips", -1, kNone},
                       {"Spine", 0, kNone},
                       {"Spine1", 1, kNone},
                       {"Neck", 2, kNone},
                       {"Head", 3, kNone},
                       {"LeftUpLeg", 0, kNone},
                       {"LeftLeg", 5, kNone},
                       {"LeftFoot", 6, kNone},
                       {"Arm_of_nobody", 2, kNone},
                       {"Hand_of_nobody", 8, kNone}});
  const SkeletonMatch half = matcher->Match(trunk.skeleton, wrinkle::Rig(), nullptr);
  EXPECT_THAT(Describe(half), HasSubstr(" roles, 8 of 10 joints"));
  EXPECT_THAT(WarningsOf(half), ElementsAre(HasSubstr("1 joint of trunk and limbs (Arm_of")));
}

}  // namespace
}  // namespace furrow::rig

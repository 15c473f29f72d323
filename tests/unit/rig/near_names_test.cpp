// SPDX-License-Identifier: Apache-2.0
#include "rig/near_names.h"

#include <vector>

#include <gtest/gtest.h>

namespace furrow::rig {
namespace {

using enum wrinkle::JointRole;
using Names = std::vector<std::string>;

constexpr char kBody[] = R"({
  "version": 1, "name": "body", "sides": {"left": "Left", "right": "Right"},
  "joints": {"hips": "Hips", "head": "Head", "*UpperArm": "*Arm", "*LowerArm": "*ForeArm",
             "*Hand": "*Hand", "*IndexProximal": "*HandIndex1"}
})";

std::vector<SkeletonMap> Maps() { return {ParseSkeletonMap(kBody, "body.json").value()}; }

TEST(RolesOfNearNames, FindsNamesWithWordsAroundThem) {
  const Names joints = {"world",        "c_hips_jnt",      "c_head_jnt",
                        "left_arm_jnt", "left_fore_arm_1", "left_hand_index_1_jnt",
                        "L_Left-Hand"};
  const SkeletonRoles found = RolesOfNearNames(Maps(), joints);
  EXPECT_EQ(found.map, "body");
  EXPECT_EQ(found.num_roles, 6);
  EXPECT_EQ(found.roles, (wrinkle::JointRoles{kNone, kHips, kHead, kLeftUpperArm, kLeftLowerArm,
                                              kLeftIndexProximal, kLeftHand}));
}

TEST(RolesOfNearNames, TheFirstJointOfANameHasTheRole) {
  const Names joints = {"hips_a",        "head_a",     "leftarm_a", "leftarm_twist",
                        "leftforearm_a", "lefthand_a", "rightarm_a"};
  const SkeletonRoles found = RolesOfNearNames(Maps(), joints);
  EXPECT_EQ(found.num_roles, 6);
  ASSERT_EQ(found.roles.size(), joints.size());
  EXPECT_EQ(found.roles[2], kLeftUpperArm);
  EXPECT_EQ(found.roles[3], kNone);
}

TEST(RolesOfNearNames, FewNamesAreCoincidence) {
  EXPECT_EQ(RolesOfNearNames(Maps(), Names{"hips_a", "head_a", "fin_1", "fin_2"}).map, "");
  EXPECT_EQ(RolesOfNearNames(Maps(), Names{}).map, "");
  EXPECT_EQ(RolesOfNearNames({}, Names{"hips_a"}).map, "");
}

}  // namespace
}  // namespace furrow::rig

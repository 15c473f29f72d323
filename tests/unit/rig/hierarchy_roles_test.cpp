// SPDX-License-Identifier: Apache-2.0
#include "rig/hierarchy_roles.h"

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "motion/clip_file.h"
#include "rig/skeleton_match.h"
#include "tests/unit/rig/shipped_matcher.h"

namespace furrow::rig {
namespace {

using enum wrinkle::JointRole;

struct Place {
  const char* name;
  int parent;
  glm::vec3 at;  // model space
};

wrinkle::Skeleton Make(const std::vector<Place>& places) {
  std::vector<wrinkle::JointDesc> joints;
  for (const Place& place : places) {
    wrinkle::JointDesc joint{.name = place.name, .parent = place.parent, .rest = {}, .tail = {}};
    joint.rest.translation =
        place.parent < 0 ? place.at : place.at - places[static_cast<std::size_t>(place.parent)].at;
    joints.push_back(joint);
  }
  return *wrinkle::Skeleton::Create(std::move(joints));
}

// A person whose joints are numbered.
wrinkle::Skeleton Person() {
  return Make({{"j0", -1, {0, 1, 0}},
               {"j1", 0, {0, 1.2f, 0}},
               {"j2", 1, {0, 1.4f, 0}},
               {"j3", 2, {0, 1.5f, 0}},
               {"j4", 3, {0, 1.6f, 0}},
               {"a0", 2, {0.2f, 1.4f, 0}},
               {"a1", 5, {0.5f, 1.4f, 0}},
               {"a2", 6, {0.8f, 1.4f, 0}},
               {"b0", 2, {-0.2f, 1.4f, 0}},
               {"b1", 8, {-0.5f, 1.4f, 0}},
               {"b2", 9, {-0.8f, 1.4f, 0}},
               {"l0", 0, {0.1f, 0.9f, 0}},
               {"l1", 11, {0.1f, 0.5f, 0}},
               {"l2", 12, {0.1f, 0.1f, 0}},
               {"l3", 13, {0.1f, 0, 0.15f}},
               {"r0", 0, {-0.1f, 0.9f, 0}},
               {"r1", 15, {-0.1f, 0.5f, 0}},
               {"r2", 16, {-0.1f, 0.1f, 0}},
               {"r3", 17, {-0.1f, 0, 0.15f}}});
}

TEST(HierarchyRoles, FindsTheLimbsOfAPerson) {
  const wrinkle::Skeleton person = Person();
  const wrinkle::JointRoles roles = RolesFromHierarchy(person);
  ASSERT_EQ(roles.size(), 19u);
  EXPECT_EQ(roles[0], kHips);
  EXPECT_EQ(roles[5], kLeftUpperArm);
  EXPECT_EQ(roles[7], kLeftHand);
  EXPECT_EQ(roles[9], kRightLowerArm);
  EXPECT_EQ(roles[12], kLeftLowerLeg);
  EXPECT_EQ(roles[14], kLeftToes);
  EXPECT_EQ(roles[17], kRightFoot);
  EXPECT_TRUE(RolesFromHierarchy(wrinkle::Skeleton()).empty());
}

// A spine along Z, with legs across it at both ends.
TEST(HierarchyRoles, AFoxIsNotAPerson) {
  EXPECT_TRUE(RolesFromHierarchy(Make({{"hips", -1, {0, 0.5f, -0.4f}},
                                       {"spine", 0, {0, 0.5f, 0}},
                                       {"chest", 1, {0, 0.5f, 0.4f}},
                                       {"neck", 2, {0, 0.6f, 0.5f}},
                                       {"head", 3, {0, 0.7f, 0.6f}},
                                       {"fl0", 2, {0.1f, 0.4f, 0.4f}},
                                       {"fl1", 5, {0.1f, 0.2f, 0.4f}},
                                       {"fl2", 6, {0.1f, 0, 0.4f}},
                                       {"fr0", 2, {-0.1f, 0.4f, 0.4f}},
                                       {"fr1", 8, {-0.1f, 0.2f, 0.4f}},
                                       {"fr2", 9, {-0.1f, 0, 0.4f}},
                                       {"hl0", 0, {0.1f, 0.4f, -0.4f}},
                                       {"hl1", 11, {0.1f, 0.2f, -0.4f}},
                                       {"hl2", 12, {0.1f, 0, -0.4f}},
                                       {"hr0", 0, {-0.1f, 0.4f, -0.4f}},
                                       {"hr1", 14, {-0.1f, 0.2f, -0.4f}},
                                       {"hr2", 15, {-0.1f, 0, -0.4f}}}))
                  .empty());
}

// CMU's names say which joint is which.
TEST(HierarchyRoles, AgreesWithTheNamesOfCmu) {
  const std::filesystem::path take = FURROW_SHARED_DATA "/cmu/01_01.bvh";
  if (!std::filesystem::exists(take)) GTEST_SKIP() << take << " is missing";
  const auto clip = motion::LoadClip(take);
  ASSERT_TRUE(clip.ok()) << clip.status().ToString();
  const auto matcher = ShippedMatcher();
  ASSERT_TRUE(matcher.ok()) << matcher.status().ToString();
  const SkeletonRoles named = matcher->RolesOf(clip->skeleton);
  ASSERT_EQ(named.map, "cmu");
  const wrinkle::JointRoles guessed = RolesFromHierarchy(clip->skeleton);
  ASSERT_EQ(guessed.size(), named.roles.size());
  for (std::size_t i = 0; i < guessed.size(); ++i) {
    if (!wrinkle::IsOfLimb(named.roles[i])) continue;
    EXPECT_EQ(guessed[i], named.roles[i]) << clip->skeleton.joint_names()[i];
  }
}

TEST(HierarchyRoles, AStreamThatNoMapFitsGetsThem) {
  const auto matcher = ShippedMatcher();
  ASSERT_TRUE(matcher.ok()) << matcher.status().ToString();
  const wrinkle::Skeleton person = Person();
  const SkeletonRoles found = matcher->RolesOf(person);
  ASSERT_EQ(found.map, kFromHierarchy);
  EXPECT_EQ(found.roles[12], kLeftLowerLeg);
  EXPECT_NE(Describe(found).find("guessed from the hierarchy"), std::string::npos);
  // The proposed map finds the same roles.
  const auto map =
      ParseSkeletonMap(ProposeSkeletonMap("mine", person.joint_names(), found.roles), "mine.json");
  ASSERT_TRUE(map.ok()) << map.status().ToString();
  EXPECT_EQ(ApplySkeletonMap(*map, person.joint_names()).roles, found.roles);
}

}  // namespace
}  // namespace furrow::rig

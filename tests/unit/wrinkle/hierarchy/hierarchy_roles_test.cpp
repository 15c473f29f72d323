// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/hierarchy/hierarchy_roles.h"

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace furrow::wrinkle {
namespace {

using enum JointRole;

struct Place {
  const char* name;
  int parent;
  glm::vec3 at;  // model space
};

Skeleton Make(const std::vector<Place>& places) {
  std::vector<JointDesc> joints;
  for (const Place& place : places) {
    JointDesc joint{.name = place.name, .parent = place.parent, .rest = {}, .tail = {}};
    joint.rest.translation =
        place.parent < 0 ? place.at : place.at - places[static_cast<std::size_t>(place.parent)].at;
    joints.push_back(joint);
  }
  return *Skeleton::Create(std::move(joints));
}

// A person whose joints are numbered.
std::vector<Place> PersonPlaces() {
  return {{"j0", -1, {0, 1, 0}},        {"j1", 0, {0, 1.2f, 0}},      {"j2", 1, {0, 1.4f, 0}},
          {"j3", 2, {0, 1.5f, 0}},      {"j4", 3, {0, 1.6f, 0}},      {"a0", 2, {0.2f, 1.4f, 0}},
          {"a1", 5, {0.5f, 1.4f, 0}},   {"a2", 6, {0.8f, 1.4f, 0}},   {"b0", 2, {-0.2f, 1.4f, 0}},
          {"b1", 8, {-0.5f, 1.4f, 0}},  {"b2", 9, {-0.8f, 1.4f, 0}},  {"l0", 0, {0.1f, 0.9f, 0}},
          {"l1", 11, {0.1f, 0.5f, 0}},  {"l2", 12, {0.1f, 0.1f, 0}},  {"l3", 13, {0.1f, 0, 0.15f}},
          {"r0", 0, {-0.1f, 0.9f, 0}},  {"r1", 15, {-0.1f, 0.5f, 0}}, {"r2", 16, {-0.1f, 0.1f, 0}},
          {"r3", 17, {-0.1f, 0, 0.15f}}};
}

TEST(HierarchyRoles, FindsTheLimbsOfAPerson) {
  const Skeleton person = Make(PersonPlaces());
  const JointRoles roles = RolesFromHierarchy(person);
  ASSERT_EQ(roles.size(), 19u);
  EXPECT_EQ(roles[0], kHips);
  EXPECT_EQ(roles[5], kLeftUpperArm);
  EXPECT_EQ(roles[7], kLeftHand);
  EXPECT_EQ(roles[9], kRightLowerArm);
  EXPECT_EQ(roles[12], kLeftLowerLeg);
  EXPECT_EQ(roles[14], kLeftToes);
  EXPECT_EQ(roles[17], kRightFoot);
  EXPECT_TRUE(RolesFromHierarchy(Skeleton()).empty());
}

// A person with a bone from the hips to each buttock, where the thigh starts.
std::vector<Place> WithButtocks(std::vector<Place> person, const glm::vec3& left) {
  for (const char* leg : {"l0", "r0"}) {
    const auto named = [leg](const Place& place) { return place.name == std::string_view(leg); };
    const auto thigh = std::ranges::find_if(person, named) - person.begin();
    const float side = *leg == 'l' ? 1.0f : -1.0f;
    const int buttock = static_cast<int>(person.size());
    person.push_back({*leg == 'l' ? "bl" : "br", 0, left * glm::vec3(side, 1, 1)});
    person[static_cast<std::size_t>(thigh)].parent = buttock;
  }
  return person;
}

JointRole RoleOf(const Skeleton& skeleton, const JointRoles& roles, const char* joint) {
  const auto index = static_cast<std::size_t>(skeleton.Find(joint));
  return index < roles.size() ? roles[index] : kNone;
}

TEST(HierarchyRoles, AShortBoneAboveTheThighIsNoThigh) {
  // Beside the thigh, behind the hips, and where both buttocks start in one place.
  for (const glm::vec3& at :
       {glm::vec3(0.05f, 0.95f, 0), glm::vec3(0.08f, 1, -0.1f), glm::vec3(0, 0.95f, -0.05f)}) {
    const Skeleton person = Make(WithButtocks(PersonPlaces(), at));
    const JointRoles roles = RolesFromHierarchy(person);
    EXPECT_EQ(RoleOf(person, roles, "bl"), kNone);
    EXPECT_EQ(RoleOf(person, roles, "l0"), kLeftUpperLeg);
    EXPECT_EQ(RoleOf(person, roles, "l1"), kLeftLowerLeg);
    EXPECT_EQ(RoleOf(person, roles, "r2"), kRightFoot);
    EXPECT_EQ(RoleOf(person, roles, "r3"), kRightToes);
    EXPECT_EQ(RoleOf(person, roles, "a0"), kLeftUpperArm);
  }
}

// Half as long as the shin, but not as short as the foot.
TEST(HierarchyRoles, AShortThighStaysAThigh) {
  std::vector<Place> places = PersonPlaces();
  for (const std::size_t thigh : {11u, 15u}) places[thigh].at.y = 0.7f;
  const Skeleton person = Make(places);
  const JointRoles roles = RolesFromHierarchy(person);
  EXPECT_EQ(RoleOf(person, roles, "l0"), kLeftUpperLeg);
  EXPECT_EQ(RoleOf(person, roles, "r2"), kRightFoot);
}

// A spine along Z, with legs across it at both ends.
std::vector<Place> FoxPlaces() {
  return {{"hips", -1, {0, 0.5f, -0.4f}},   {"spine", 0, {0, 0.5f, 0}},
          {"chest", 1, {0, 0.5f, 0.4f}},    {"neck", 2, {0, 0.6f, 0.5f}},
          {"head", 3, {0, 0.7f, 0.6f}},     {"fl0", 2, {0.1f, 0.4f, 0.4f}},
          {"fl1", 5, {0.1f, 0.2f, 0.4f}},   {"fl2", 6, {0.1f, 0, 0.4f}},
          {"fr0", 2, {-0.1f, 0.4f, 0.4f}},  {"fr1", 8, {-0.1f, 0.2f, 0.4f}},
          {"fr2", 9, {-0.1f, 0, 0.4f}},     {"hl0", 0, {0.1f, 0.4f, -0.4f}},
          {"hl1", 11, {0.1f, 0.2f, -0.4f}}, {"hl2", 12, {0.1f, 0, -0.4f}},
          {"hr0", 0, {-0.1f, 0.4f, -0.4f}}, {"hr1", 14, {-0.1f, 0.2f, -0.4f}},
          {"hr2", 15, {-0.1f, 0, -0.4f}}};
}

TEST(HierarchyRoles, AFoxIsNotAPerson) {
  EXPECT_TRUE(RolesFromHierarchy(Make(FoxPlaces())).empty());
}

// Its hind legs are bent: the hocks are behind the hips.
std::vector<Place> DogPlaces() {
  std::vector<Place> dog = FoxPlaces();
  for (const std::size_t hip : {11u, 14u}) {
    const float side = dog[hip].at.x;
    dog[hip + 1].at = {side, 0.3f, -0.3f};
    dog[hip + 2].at = {side, 0.15f, -0.6f};
    dog.push_back({hip == 11u ? "hl3" : "hr3", static_cast<int>(hip) + 2, {side, 0, -0.5f}});
  }
  return dog;
}

// Higher at the chest than at the hips.
std::vector<Place> GiraffePlaces() {
  std::vector<Place> giraffe = FoxPlaces();
  for (Place& place : giraffe) {
    if (place.at.z > -0.4f) place.at.y += place.at.z + 0.4f;
  }
  return giraffe;
}

TEST(HierarchyRoles, BentLegsAndASlopingBackAreNotAPerson) {
  EXPECT_TRUE(RolesFromHierarchy(Make(DogPlaces())).empty());
  EXPECT_TRUE(RolesFromHierarchy(Make(GiraffePlaces())).empty());
}

// Hanging arms do not make front legs of a person's.
TEST(HierarchyRoles, APersonMayLetTheArmsHang) {
  std::vector<Place> person = PersonPlaces();
  for (const std::size_t arm : {5u, 8u}) {
    for (std::size_t i = 1; i < 3; ++i) {
      person[arm + i].at = person[arm].at - glm::vec3(0, 0.3f * static_cast<float>(i), 0);
    }
  }
  EXPECT_EQ(RolesFromHierarchy(Make(person)).size(), person.size());
}

void ExpectUp(const std::vector<Place>& body, const glm::vec3& up, bool is_upright) {
  const auto shape = FindBodyShape(Make(body));
  ASSERT_TRUE(shape.has_value());
  EXPECT_GT(glm::dot(shape->up, up), 0.9f);
  EXPECT_EQ(shape->is_upright, is_upright);
  EXPECT_EQ(shape->root, 0);
  EXPECT_EQ(shape->head, 4);
}

// Z-up, and facing -Y.
std::vector<Place> ZUp(std::vector<Place> body) {
  for (Place& place : body) place.at = {place.at.x, -place.at.z, place.at.y};
  return body;
}

TEST(BodyShape, UpIsAwayFromTheFeet) {
  ExpectUp(PersonPlaces(), {0, 1, 0}, true);
  ExpectUp(ZUp(PersonPlaces()), {0, 0, 1}, true);
  ExpectUp(FoxPlaces(), {0, 1, 0}, false);
  ExpectUp(ZUp(FoxPlaces()), {0, 0, 1}, false);
  ExpectUp(DogPlaces(), {0, 1, 0}, false);
  ExpectUp(GiraffePlaces(), {0, 1, 0}, false);
}

TEST(BodyShape, IsUnknownWithoutTwoPairsOfLimbs) {
  EXPECT_FALSE(FindBodyShape(Skeleton()));
  std::vector<Place> bust = PersonPlaces();
  bust.resize(11);
  EXPECT_FALSE(FindBodyShape(Make(bust)));
}

// LaFAN1 rests with all bones along +X.
TEST(BodyShape, IsUnknownIfAllBonesLieOnOneLine) {
  std::vector<Place> line = PersonPlaces();
  for (Place& place : line) {
    if (place.parent >= 0) {
      place.at = line[static_cast<std::size_t>(place.parent)].at + glm::vec3(0.3f, 0, 0);
    }
  }
  EXPECT_FALSE(FindBodyShape(Make(line)));
}

}  // namespace
}  // namespace furrow::wrinkle

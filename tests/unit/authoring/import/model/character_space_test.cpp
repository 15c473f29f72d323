// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/model/character_space.h"

#include <initializer_list>

#include <gtest/gtest.h>

#include "tests/unit/authoring/import/model/toy_body.h"

namespace furrow::authoring {
namespace {

using wrinkle::JointRole;

// The roles of the toy body's joints, from the first to the last.
FoundJoints Roles(std::initializer_list<JointRole> roles) {
  FoundJoints joints;
  joints.roles = roles;
  joints.roles.resize(static_cast<std::size_t>(ToyBody().skeleton.num_joints()), JointRole::kNone);
  return joints;
}

// The metres per unit of the toy body in a file whose metre has `units` units.
float ScaleOf(float units, const FoundJoints& joints) {
  character::Character body = ToyBody();
  EXPECT_TRUE(MoveToSpace(glm::mat3(1.0f), units, &body).ok());
  return FindCharacterSpace(body, joints).scale;
}

TEST(CharacterSpace, LegsMakeABody) {
  const FoundJoints legs = Roles({JointRole::kLeftUpperLeg});
  EXPECT_EQ(FindCharacterSpace(ToyBody(), legs).kind, ModelKind::kBody);
  EXPECT_EQ(ScaleOf(1.0f, legs), 1.0f);
  EXPECT_EQ(ScaleOf(100.0f, legs), 0.01f);
  EXPECT_EQ(ScaleOf(39.37f, legs), 0.0254f);
}

TEST(CharacterSpace, AHeadHasNoHips) {
  const FoundJoints head = Roles({JointRole::kNeck, JointRole::kHead});
  EXPECT_EQ(FindCharacterSpace(ToyBody(), head).kind, ModelKind::kHead);
  EXPECT_EQ(ScaleOf(0.2f, head), 1.0f);
  EXPECT_EQ(ScaleOf(20.0f, head), 0.01f);
  EXPECT_EQ(FindCharacterSpace(ToyBody(), Roles({JointRole::kHips, JointRole::kHead})).kind,
            ModelKind::kUnknown);
}

// A body of unknown joints used to pass for a head of 1.7 m.
TEST(CharacterSpace, UnknownJointsMayBeThoseOfABody) {
  EXPECT_EQ(ScaleOf(1.0f, Roles({})), 1.0f);
  EXPECT_EQ(ScaleOf(0.2f, Roles({})), 1.0f);
  EXPECT_EQ(ScaleOf(100.0f, Roles({})), 0.01f);
  EXPECT_EQ(ScaleOf(1000.0f, Roles({})), 0.001f);
}

}  // namespace
}  // namespace furrow::authoring

// SPDX-License-Identifier: Apache-2.0
#include "authoring/shapes/shape_landmarks.h"

#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "authoring/generator/head/head_shape.h"
#include "authoring/shapes/arkit_face.h"
#include "tests/unit/authoring/shapes/shape_head.h"

namespace furrow::authoring {
namespace {

class ShapeLandmarksTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    face_ = new character::Character(MakeShapeHead());
    arkit_ = new ArkitFace(*face_, rig::ShapeMatcher());
  }
  static void TearDownTestSuite() {
    delete arkit_;
    delete face_;
  }
  static character::Character* face_;
  static ArkitFace* arkit_;
};
character::Character* ShapeLandmarksTest::face_ = nullptr;
ArkitFace* ShapeLandmarksTest::arkit_ = nullptr;

// The default head has known proportions: head_shape.h, in centimetres from between the eyes.
TEST_F(ShapeLandmarksTest, LieAtTheirPlacesOnTheDefaultHead) {
  const auto skin = FaceSkin::Create(*face_, *arkit_);
  ASSERT_TRUE(skin.ok()) << skin.status().ToString();
  EXPECT_NEAR(skin->middle(), 0.0f, 0.002f);
  EXPECT_NEAR(skin->eye_distance(), 0.02f * kEyeCentre.x, 0.006f);
  const ShapeLandmarks at = FindShapeLandmarks(*skin);
  const auto expect = [](const char* name, const LandmarkPair& pair, float x, float y) {
    SCOPED_TRACE(name);
    ASSERT_TRUE(pair.left && pair.right);
    const glm::vec3 left = ModelToHead(*pair.left), right = ModelToHead(*pair.right);
    EXPECT_LT(glm::distance(glm::vec2(left), glm::vec2(x, y)), 0.9f) << left.x << " " << left.y;
    EXPECT_LT(glm::distance(glm::vec2(right), glm::vec2(-x, y)), 0.9f) << right.x << " " << right.y;
  };
  expect("inner brow", at.brow_inner, 1.4f, 2.4f);
  expect("outer brow", at.brow_outer, 4.5f, 2.7f);
  expect("upper lid", at.upper_lid, kEyeCentre.x, 0.5f);
  expect("lower lid", at.lower_lid, kEyeCentre.x, -0.6f);
  expect("mouth corner", at.mouth_corner, kMouthCornerX, kMouthY);
  expect("nose wing", at.nose_wing, 1.4f, -4.2f);
  expect("cheek", at.cheek, 4.3f, -3.4f);
  ASSERT_TRUE(at.chin && at.upper_lip && at.lower_lip);
  EXPECT_LT(ModelToHead(*at.chin).y, -9.0f);
  EXPECT_GT(at.upper_lip->y, at.lower_lip->y);
  EXPECT_NEAR(ModelToHead(*at.upper_lip).y, kMouthY, 0.8f);
}

TEST_F(ShapeLandmarksTest, OnlyTheMeshThatBrowsAndMouthMoveIsSkin) {
  const auto skin = FaceSkin::Create(*face_, *arkit_);
  ASSERT_TRUE(skin.ok());
  ASSERT_EQ(skin->meshes().size(), 1u);
  EXPECT_EQ(face_->meshes[static_cast<std::size_t>(skin->meshes()[0])].name, "head");
  EXPECT_TRUE(skin->Moves("tongueOut").size() == skin->positions().size());
  EXPECT_TRUE(skin->Moves("eyeLookInLeft").empty());  // turns the eye only
  EXPECT_TRUE(skin->Moves("noSuchShape").empty());
}

// A face that looks backward has its left eye at the smaller x.
TEST_F(ShapeLandmarksTest, ExchangedEyesAreNoFace) {
  character::Character face = *face_;
  for (std::string& name : face.shapes) {
    if (name == "eyeBlinkLeft") {
      name = "eyeBlinkRight";
    } else if (name == "eyeBlinkRight") {
      name = "eyeBlinkLeft";
    }
  }
  const ArkitFace arkit(face, rig::ShapeMatcher());
  const auto skin = FaceSkin::Create(face, arkit);
  EXPECT_EQ(skin.status().code(), StatusCode::kNotFound);
}

TEST_F(ShapeLandmarksTest, MissingShapesLeaveTheirLandmarksEmpty) {
  character::Character face = *face_;
  for (std::string& name : face.shapes) {
    if (name.starts_with("noseSneer") || name == "jawOpen") name += "X";
  }
  const ArkitFace arkit(face, rig::ShapeMatcher());
  const auto skin = FaceSkin::Create(face, arkit);
  ASSERT_TRUE(skin.ok());
  const ShapeLandmarks at = FindShapeLandmarks(*skin);
  EXPECT_FALSE(at.nose_wing.left);
  EXPECT_FALSE(at.chin);
  EXPECT_TRUE(at.mouth_corner.left);
}

}  // namespace
}  // namespace furrow::authoring

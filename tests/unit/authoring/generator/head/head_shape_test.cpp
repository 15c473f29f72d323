// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/head/head_shape.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "authoring/generator/head/head_mesh.h"

namespace furrow::authoring {
namespace {

using glm::vec3;

// The z coordinate of the face at (x, y), cast from the front.
float Depth(const HeadShape& shape, float x, float y) {
  return shape.Cast({x, y, 20.0f}, {0, 0, -1}, 20.0f).z;
}

// The height in [low, high] at which the midline of the face protrudes most.
float Peak(const HeadShape& shape, float low, float high) {
  float best = low;
  for (float y = low; y <= high; y += 0.02f) {
    if (Depth(shape, 0.0f, y) > Depth(shape, 0.0f, best)) best = y;
  }
  return best;
}

// The height in [low, high] at which the midline of the face is deepest.
float Dip(const HeadShape& shape, float low, float high) {
  float best = low;
  for (float y = low; y <= high; y += 0.02f) {
    if (Depth(shape, 0.0f, y) < Depth(shape, 0.0f, best)) best = y;
  }
  return best;
}

std::vector<FaceParameters> Faces() {
  return {{}, {.sex = -1.0f, .age = 65.0f}, {.sex = 0.0f, .age = 25.0f}, {.sex = 1.0f, .age = 80}};
}

// Averages of adults, in centimetres. FaceParameters change them only within the human range.
TEST(HeadShape, HasAdultProportions) {
  for (const FaceParameters& face : Faces()) {
    SCOPED_TRACE(testing::Message() << "sex " << face.sex << " age " << face.age);
    const HeadShape shape(face);
    const float crown = shape.Cast({0, 40, -1}, {0, -1, 0}, 60).y;
    const vec3 back = shape.Cast({0, 1, -40}, {0, 0, 1}, 60);
    const float width =
        shape.Cast({40, 3, -2}, {-1, 0, 0}, 60).x - shape.Cast({-40, 3, -2}, {1, 0, 0}, 60).x;
    EXPECT_NEAR(crown, 11.5f, 0.5f);  // the eyes are at half of 23 cm
    EXPECT_NEAR(width, 15.5f, 0.9f);
    EXPECT_NEAR(Depth(shape, 0, 2.1f) - back.z, 19.5f, 0.9f);  // glabella to the back
    // Two equal thirds: brow to the base of the nose, and base of the nose to chin.
    const float nose_base = Dip(shape, -5.6f, -4.7f);
    const float chin = -10.6f;
    EXPECT_NEAR(2.0f - nose_base, 6.6f, 0.8f);
    EXPECT_LT(shape.Distance({0, chin, 7.5f}), 0.0f);
    EXPECT_GT(shape.Distance({0, chin - 1.6f, 8.6f}), 0.0f);
    // The mouth is at a third of the distance from the base of the nose to the chin.
    const float way = (nose_base - kMouthY) / (nose_base + 11.2f);
    EXPECT_NEAR(way, 0.33f, 0.06f);
  }
}

TEST(HeadShape, EyesAndMouthAreInPlace) {
  EXPECT_NEAR(2.0f * kEyeCentre.x, 6.3f, 0.2f);  // distance between the pupils
  const float eye_width = kOuterCanthusX - kInnerCanthusX;
  EXPECT_NEAR(eye_width, 3.1f, 0.3f);
  EXPECT_NEAR(2.0f * kInnerCanthusX, eye_width, 0.6f);  // one eye width between the eyes
  // The corners of the mouth are below the inner edges of the irises.
  EXPECT_NEAR(kMouthCornerX, kEyeCentre.x - 0.585f, 0.2f);
  EXPECT_NEAR(kEyeRadius, 1.2f, 0.01f);
}

TEST(HeadShape, HasAnAdultProfile) {
  for (const FaceParameters& face : Faces()) {
    SCOPED_TRACE(testing::Message() << "sex " << face.sex << " age " << face.age);
    const HeadShape shape(face);
    const float root = Depth(shape, 0, 0.3f);
    const float brow = Depth(shape, 0, 2.2f);
    const float tip = Depth(shape, 0, Peak(shape, -4.8f, -2.5f));
    EXPECT_LT(root, brow + 0.2f);  // the root of the nose is recessed
    EXPECT_GT(tip, root + 1.2f);
    EXPECT_LT(tip, root + 3.2f);
    const float upper_lip = Depth(shape, 0, Peak(shape, -6.75f, -5.6f));
    const float lower_lip = Depth(shape, 0, Peak(shape, -7.9f, -7.0f));
    const float under = Depth(shape, 0, Dip(shape, -9.0f, -7.9f));
    const float chin = Depth(shape, 0, Peak(shape, -10.6f, -8.9f));
    EXPECT_GT(upper_lip, lower_lip - 0.1f);
    EXPECT_LT(under, lower_lip - 0.3f);
    EXPECT_LT(chin, lower_lip + 0.15f);  // a little behind the lower lip
    EXPECT_GT(chin, lower_lip - 1.4f);
    // The gap between the lips is a groove, not a hole.
    const float seam = Depth(shape, 0, kMouthY);
    EXPECT_LT(seam, lower_lip);
    EXPECT_GT(seam, lower_lip - 0.8f);
  }
}

TEST(HeadShape, SexAndAgeChangeTheExpectedFeatures) {
  const HeadShape man({.sex = 1.0f, .age = 25.0f}), woman({.sex = -1.0f, .age = 25.0f});
  const HeadShape old({.sex = 1.0f, .age = 75.0f});
  const auto jaw = [](const HeadShape& shape) {
    return shape.Cast({20, -7.5f, 1.5f}, {-1, 0, 0}, 20).x;
  };
  EXPECT_GT(jaw(man), jaw(woman) + 0.3f);
  EXPECT_GT(Depth(man, 2.0f, 1.8f), Depth(woman, 2.0f, 1.8f) + 0.1f);     // brow ridge
  EXPECT_GT(Depth(woman, 0.4f, -6.5f), Depth(old, 0.4f, -6.5f) + 0.05f);  // lips become thinner
  // With age jowls sag beside the chin and temples hollow.
  EXPECT_LT(old.Distance({4.6f, -9.4f, 5.4f}), man.Distance({4.6f, -9.4f, 5.4f}) - 0.1f);
  EXPECT_GT(old.Distance({6.9f, 2.6f, 4.2f}), man.Distance({6.9f, 2.6f, 4.2f}) + 0.1f);
}

TEST(HeadShape, IsSlightlyAsymmetric) {
  const HeadShape shape;
  float most = 0.0f;
  for (float y = -9.0f; y < 3.0f; y += 0.5f) {
    for (const float x : {0.6f, 1.5f, 3.0f, 4.5f}) {
      most = std::max(most, std::abs(Depth(shape, x, y) - Depth(shape, -x, y)));
    }
  }
  EXPECT_GT(most, 0.05f);
  EXPECT_LT(most, 0.6f);
}

TEST(HeadShape, DistanceGrowsByAboutOnePerCentimetre) {
  const HeadShape shape;
  for (const vec3& from : {vec3(0, 4, 20), vec3(3, -4, 20), vec3(0, -10, 20), vec3(-5, 1, 15)}) {
    const vec3 on = shape.Cast(from, {0, 0, -1}, 20);
    const vec3 normal = shape.Normal(on);
    EXPECT_NEAR(glm::length(normal), 1.0f, 1e-5f);
    EXPECT_NEAR(shape.Distance(on), 0.0f, 0.01f);
    EXPECT_NEAR(shape.Distance(on + normal * 0.5f), 0.5f, 0.15f);
  }
}

TEST(FaceParameters, WrinklesDeepenWithAge) {
  EXPECT_FLOAT_EQ(WrinkleDepth({.age = 30.0f}), 1.0f);
  float last = 0.0f;
  for (float age = 18.0f; age <= 90.0f; age += 4.0f) {
    EXPECT_GE(WrinkleDepth({.age = age}), last);
    last = WrinkleDepth({.age = age});
  }
  EXPECT_GT(WrinkleDepth({.age = 65.0f}), 1.5f);
  EXPECT_LT(WrinkleDepth({.age = 18.0f}), 0.8f);
  EXPECT_EQ(GreyShare({.age = 25.0f}), 0.0f);
  EXPECT_GT(GreyShare({.age = 65.0f}), 0.7f);
  EXPECT_FLOAT_EQ(GreyShare({.age = 65.0f, .grey = 0.2f}), 0.2f);
}

}  // namespace
}  // namespace furrow::authoring

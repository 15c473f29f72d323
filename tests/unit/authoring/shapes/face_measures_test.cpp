// SPDX-License-Identifier: Apache-2.0
#include "authoring/shapes/face_measures.h"

#include <gtest/gtest.h>

#include "authoring/shapes/stroke_transfer.h"

namespace furrow::authoring {
namespace {

// The default face with the chin at `height` eye distances below the upper lids.
FaceMeasures FaceOfHeight(float height) {
  FaceMeasures face = DefaultFaceMeasures();
  face.chin = face.lid - height * face.eye_distance;
  return face;
}

TEST(FaceMeasures, AdultsFoldInFullAndDrawnFacesHardly) {
  EXPECT_FLOAT_EQ(FoldDepthOf(DefaultFaceMeasures()), 1.0f);
  EXPECT_FLOAT_EQ(FoldDepthOf(FaceOfHeight(1.73f)), 1.0f) << "a grown-up avatar";
  EXPECT_FLOAT_EQ(FoldDepthOf(FaceOfHeight(1.21f)), 0.3f) << "a face drawn by VRoid Studio";
}

TEST(FaceMeasures, FoldDepthGrowsWithTheHeightOfTheFaceAndNotWithItsSize) {
  float before = 0.0f;
  for (float height = 1.0f; height < 2.0f; height += 0.05f) {
    FaceMeasures face = FaceOfHeight(height);
    const float depth = FoldDepthOf(face);
    EXPECT_GE(depth, before) << height;
    before = depth;
    face.eye_distance *= 100.0f;
    face.lid *= 100.0f;
    face.chin *= 100.0f;
    EXPECT_NEAR(FoldDepthOf(face), depth, 1e-4f) << height;
  }
  EXPECT_EQ(FoldDepthOf(FaceMeasures{}), 0.3f) << "not measured, and no division by 0";
}

}  // namespace
}  // namespace furrow::authoring

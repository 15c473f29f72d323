// SPDX-License-Identifier: Apache-2.0
#include "authoring/export/export_pictures.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/authoring/export/small_face.h"

namespace furrow::authoring {
namespace {

using ::testing::ElementsAre;

render::DerivativeMap OneSlope(float x, float y) { return {1, 1, {x, y}}; }

TEST(ExportPictures, NormalsAreUnitVectorsInTheEnginesConvention) {
  // n = (1, 2, 1) / sqrt(6): values worked out by hand.
  const auto up = NormalMapPicture(OneSlope(1.0f, 2.0f), {8, false});
  EXPECT_EQ(up.channels, 3);
  EXPECT_THAT(up.pixels,
              ElementsAre(180, 232, 180));  // 127.5 + 127.5 * (0.40825, 0.81650, 0.40825)
  const auto down = NormalMapPicture(OneSlope(1.0f, 2.0f), {8, true});
  EXPECT_THAT(down.pixels, ElementsAre(180, 23, 180));
  const auto fine = NormalMapPicture(OneSlope(0.0f, 0.0f), {16, false});
  EXPECT_TRUE(fine.pixels.empty());
  EXPECT_THAT(fine.pixels16, ElementsAre(32768, 32768, 65535));
}

TEST(ExportPictures, DerivativesAreThoseOfHeights) {
  // Slopes are -grad h. The scale is the largest: 2.
  const auto up = DerivativeMapPicture(OneSlope(1.0f, -2.0f), {8, false});
  EXPECT_FLOAT_EQ(up.scale, 2.0f);
  EXPECT_EQ(up.picture.channels, 3);
  EXPECT_THAT(up.picture.pixels, ElementsAre(64, 255, 0));
  const auto down = DerivativeMapPicture(OneSlope(1.0f, -2.0f), {8, true});
  EXPECT_THAT(down.picture.pixels, ElementsAre(64, 0, 0));
  const auto flat = DerivativeMapPicture(OneSlope(0.0f, 0.0f), {16, false});
  EXPECT_GT(flat.scale, 0.0f);
  EXPECT_THAT(flat.picture.pixels16, ElementsAre(32768, 32768, 0));
}

TEST(ExportPictures, SixteenBitsKeepSlopes) {
  for (const float slope : {-12.0f, -1.0f, -0.01f, 0.0f, 0.3f, 5.0f}) {
    const auto picture = NormalMapPicture(OneSlope(slope, -slope / 3.0f), {16, false});
    const auto back = render::DerivativesFromNormalMap(picture);
    EXPECT_NEAR(back.texels[0], slope, 1e-3f * (1.0f + slope * slope));
    EXPECT_NEAR(back.texels[1], -slope / 3.0f, 1e-3f * (1.0f + slope * slope));
  }
}

TEST(ExportPictures, SlopesComeFromNormalsOrDerivatives) {
  const character::Character face = test::SmallFace();
  const auto plan = PlanExport(face);
  ASSERT_TRUE(plan.ok());
  const auto stretch = SlopesOf(face, plan->maps[0]);  // 255 and 0 at a scale of 2
  EXPECT_FLOAT_EQ(stretch.texels[0], 2.0f);
  EXPECT_FLOAT_EQ(stretch.texels[1], -2.0f);
  const auto squash = SlopesOf(face, plan->maps[1]);
  EXPECT_NEAR(squash.texels[0], 1.0f, 0.01f);
  EXPECT_NEAR(squash.texels[1], -1.0f, 0.01f);
}

TEST(ExportPictures, HeightsKeepTheirScale) {
  const auto source = test::MakePicture("h", 2, 1, 1, [](int x, int, int) { return 255 * x; });
  const HeightMap map = HeightMapOf(source, 3.0f);
  EXPECT_FLOAT_EQ(map.millimetres, 3.0f);
  EXPECT_THAT(map.picture.pixels16, ElementsAre(0, 65535));
}

TEST(ExportPictures, FloatHeightsGetTheirLargest) {
  character::Picture source;
  source.width = 3;
  source.height = source.channels = 1;
  source.pixels_float = {-2.0f, 0.0f, 1.0f};
  const HeightMap map = HeightMapOf(source, 9.0f);
  EXPECT_FLOAT_EQ(map.millimetres, 2.0f);
  EXPECT_THAT(map.picture.pixels16, ElementsAre(0, 32768, 49151));
  source.pixels_float = {0.0f, 0.0f, 0.0f};
  EXPECT_GT(HeightMapOf(source, 9.0f).millimetres, 0.0f);
}

TEST(ExportPictures, MasksArePackedByRegion) {
  const character::Character face = test::SmallFace();
  std::vector<std::string> shared;
  const auto picture = MaskPicture(face, {{1, 0, 2, -1}, 4, 4}, &shared);
  EXPECT_TRUE(shared.empty());
  ASSERT_EQ(picture.pixels.size(), 64u);
  const std::size_t texel = 4 * (2 * 4 + 1);                 // x = 1, y = 2
  EXPECT_EQ(picture.pixels[texel + 0], 16 * 2 + 4 * 1 + 1);  // brow_r: green of "masks"
  EXPECT_EQ(picture.pixels[texel + 1], 16 * 2 + 4 * 1 + 0);  // brow_l: red
  // knee: 2 x 2 texels of 100 x + 50 y. (1.5, 2.5) of 4 lies at (0.25, 0.75) between their centres.
  EXPECT_EQ(picture.pixels[texel + 2], std::lround(0.25 * 100 + 0.75 * 50));
  EXPECT_EQ(picture.pixels[texel + 3], 0);
}

TEST(ExportPictures, FloatPicturesBecomeIntegers) {
  character::Picture source;
  source.width = source.height = 1;
  source.channels = 3;
  source.pixels_float = {0.5f, 2.0f, -1.0f};
  EXPECT_THAT(IntegerPicture(source).pixels, ElementsAre(128, 255, 0, 255));
  const auto same = test::MakePicture("s", 1, 1, 2, [](int, int, int c) { return c; });
  EXPECT_THAT(IntegerPicture(same).pixels, ElementsAre(0, 1));
}

}  // namespace
}  // namespace furrow::authoring

// SPDX-License-Identifier: Apache-2.0
#include "tests/observer/fold_sitter.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace furrow::observer {
namespace {

TEST(LuminanceOf, IsLinear) {
  const render::Image image{
      .width = 4, .height = 1, .rgb = {0, 0, 0, 255, 255, 255, 188, 188, 188, 0, 255, 0}};
  const Plane plane = LuminanceOf(image);
  EXPECT_EQ(plane.width, 4);
  EXPECT_EQ(plane.height, 1);
  ASSERT_EQ(plane.values.size(), 4u);
  EXPECT_EQ(plane.values[0], 0.0f);
  EXPECT_NEAR(plane.values[1], 1.0f, 1e-6f);
  EXPECT_NEAR(plane.values[2], 0.503f, 1e-3f);
  EXPECT_NEAR(plane.values[3], 0.7152f, 1e-6f);
}

// An egg of 24 cm. Its region 0 is the subject's left half: the right half of a picture from the
// front.
class EggSitter : public testing::Test {
 protected:
  EggSitter() : sitter_(render::test::MakeHead()) {
    case_.name = "left.squash";
    case_.regions = {0};
    case_.pose.SetRest(sitter_.character().skeleton);
    case_.wrinkle_weights = {0.0f, 1.0f, 0.0f, 0.0f, 0.0f};
    sitter_.Hold(case_);
  }

  FoldCase case_;
  FoldSitter sitter_;
  const FoldSitter::Shot front_{"face", 128};
};

TEST_F(EggSitter, ShowsTheRegionWhereItIsVisible) {
  const FoldPictures pictures = sitter_.Draw(front_);
  int region = 0;
  int subject = 0;
  for (int y = 0; y < 128; ++y) {
    for (int x = 0; x < 128; ++x) {
      region += pictures.region.at(x, y) > 0.5f;
      subject += pictures.subject.at(x, y) > 0.5f;
      if (pictures.region.at(x, y) < 0.5f) continue;
      EXPECT_GE(x, 63) << y;
      EXPECT_EQ(pictures.subject.at(x, y), 1.0f) << x << ", " << y;
    }
  }
  // The egg is 20 cm wide in a picture of about 30 cm. Its masks are the middle half of its height.
  EXPECT_NEAR(subject, 128 * 128 * 0.42, 128 * 128 * 0.08);
  EXPECT_NEAR(region, 0.35 * subject, 0.1 * subject);
}

TEST_F(EggSitter, FoldsTheRegionAlone) {
  const FoldPictures pictures = sitter_.Draw(front_);
  float inside = 0.0f;
  float other_half = 0.0f;
  for (int y = 0; y < 128; ++y) {
    for (int x = 0; x < 128; ++x) {
      const float difference = std::abs(pictures.on.at(x, y) - pictures.off.at(x, y));
      if (pictures.region.at(x, y) > 0.5f) inside = std::max(inside, difference);
      if (x < 40) other_half = std::max(other_half, difference);
    }
  }
  EXPECT_GT(inside, 0.02f);
  EXPECT_LT(other_half, 0.01f);
}

TEST_F(EggSitter, ControlsWhereNoFoldReaches) {
  const FoldPictures pictures = sitter_.Draw({"face", 256});
  int control = 0;
  for (int y = 0; y < 256; ++y) {
    for (int x = 0; x < 256; ++x) {
      if (pictures.control.at(x, y) < 0.5f) continue;
      ++control;
      EXPECT_EQ(pictures.subject.at(x, y), 1.0f) << x << ", " << y;
      for (int i = std::max(0, x - kFoldReach); i <= std::min(255, x + kFoldReach); ++i) {
        ASSERT_EQ(pictures.region.at(i, y), 0.0f) << x << ", " << y;
      }
      EXPECT_NEAR(pictures.on.at(x, y), pictures.off.at(x, y), 0.01f);
    }
  }
  EXPECT_GT(control, 200);
}

TEST_F(EggSitter, WeightsOfZeroAreNoWrinkles) {
  EXPECT_EQ(sitter_.Draw(front_).off.values, sitter_.DrawWithoutWrinkles(front_).values);
}

TEST_F(EggSitter, LooksAtARightJointFromTheRight) {
  const FoldSitter::Shot profile{"profile", 64};
  const auto count = [](const Plane& plane) { return std::ranges::count(plane.values, 1.0f); };
  EXPECT_GT(count(sitter_.Draw(profile).region), 300);
  case_.side = -1;  // the left half is then behind the egg
  EXPECT_LT(count(sitter_.Draw(profile).region), 20);
}

TEST_F(EggSitter, KnowsTheScale) {
  // The preset shows 1.18 heights, and a little more at the distance of its target.
  EXPECT_NEAR(sitter_.MillimetresPerPixel(front_), 1.18 * 240.0 / 128.0, 0.3);
  EXPECT_DOUBLE_EQ(sitter_.MillimetresPerPixel({"face", 256}),
                   0.5 * sitter_.MillimetresPerPixel(front_));
}

}  // namespace
}  // namespace furrow::observer

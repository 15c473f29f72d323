// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/layers/skin_grain.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/unit/authoring/bake/toys.h"

namespace furrow::authoring {
namespace {

constexpr glm::vec3 kX(1.0f, 0.0f, 0.0f), kY(0.0f, 1.0f, 0.0f);
constexpr float kFine = 1e-4f;  // metres: texels that show everything

// A fold whose height rises along x, with grain.
constexpr float kRise = 0.02f;  // metres per metre
FoldSample At(float height, float x, float y, float strength = 0.3f, float smallest = kFine) {
  const FoldSample fold{height + kRise * x, {kRise, 0.0f}, 0.8f};
  return SkinGrain(strength).Apply(fold, {x, y, 0.02f}, kX, kY, smallest);
}

TEST(SkinGrain, VariesAShallowFoldAroundItsHeight) {
  constexpr float kHeight = -2e-5f;
  double sum = 0.0, squares = 0.0;
  constexpr int kSide = 120;
  for (int i = 0; i < kSide * kSide; ++i) {
    const FoldSample fold{kHeight, {}, 1.0f};
    const glm::vec3 p(3e-4f * static_cast<float>(i % kSide), 3e-4f * static_cast<float>(i / kSide),
                      0.0f);
    const double ratio =
        static_cast<double>(SkinGrain(0.3f).Apply(fold, p, kX, kY, kFine).height / kHeight);
    EXPECT_NEAR(ratio, 1.0, 0.3 * 2.5);
    sum += ratio;
    squares += ratio * ratio;
  }
  const double mean = sum / (kSide * kSide);
  EXPECT_NEAR(mean, 1.0, 0.03);
  EXPECT_GT(std::sqrt(squares / (kSide * kSide) - mean * mean), 0.05);
}

// The structure of skin is a quarter as high as wide at most: 0.0625, 0.15, 0.375 and 1 mm, with
// shares of 0.5, 0.6, 0.8 and 0.6.
TEST(SkinGrain, DoesNotTearDeepFolds) {
  constexpr float kMost =
      0.3f * (0.5f * 0.0625f + 0.6f * 0.15f + 0.8f * 0.375f + 0.6f * 1.0f) * 1e-3f;
  for (float x = 0.0f; x < 0.03f; x += 3e-4f) {
    const FoldSample fold{-0.02f, {}, 0.5f};
    const float height = SkinGrain(0.3f).Apply(fold, {x, 0.0f, 0.0f}, kX, kY, kFine).height;
    EXPECT_NEAR(height, -0.02f, kMost);
  }
}

TEST(SkinGrain, SlopeIsTheDerivative) {
  constexpr float kStep = 1e-5f;
  for (const float height : {-0.001f, 0.0003f}) {
    for (float x = 0.001f; x < 0.01f; x += 7e-4f) {
      const FoldSample here = At(height, x, 0.5f * x);
      EXPECT_NEAR(here.slope.x, (At(height, x + kStep, 0.5f * x).height - here.height) / kStep,
                  0.015f);
      EXPECT_NEAR(here.slope.y, (At(height, x, 0.5f * x + kStep).height - here.height) / kStep,
                  0.015f);
    }
  }
}

TEST(SkinGrain, LeavesOutWhatTexelsCannotShow) {
  double fine = 0.0, coarse = 0.0;
  for (float x = 0.0f; x < 0.05f; x += 2e-4f) {
    fine += std::abs(static_cast<double>(At(0.001f, x, 0.0f).slope.y));
    coarse += std::abs(static_cast<double>(At(0.001f, x, 0.0f, 0.3f, 0.004f).slope.y));
    EXPECT_EQ(At(0.001f, x, 0.0f, 0.3f, 0.02f).height, 0.001f + kRise * x);
  }
  EXPECT_LT(coarse, 0.6 * fine);
  EXPECT_GT(coarse, 0.0);
}

TEST(SkinGrain, LeavesFlatSkinAndZeroStrengthAlone) {
  EXPECT_EQ(SkinGrain(0.5f).Apply({}, {0.1f, 0.2f, 0.3f}, kX, kY, kFine).height, 0.0f);
  EXPECT_EQ(At(0.001f, 0.01f, 0.02f, 0.0f).slope.x, kRise);
}

// A straight stroke has the same depth along its line without grain, and varies with it.
TEST(SkinGrain, BreaksUpAStroke) {
  BakeStroke stroke;
  stroke.name = "line";
  stroke.maps = {"folds"};
  stroke.points = {{0.05f, 0.01f, 0.0f}, {0.05f, 0.09f, 0.0f}};
  stroke.width_mm = 4.0f;
  stroke.depth_mm = 1.0f;
  stroke.taper = 0.2f;
  BakeOptions options = toys::Exact();
  const auto variation = [&](float strength) {
    options.skin.grain = strength;
    const BakedMap map =
        toys::BakeFolds(toys::Wearing(toys::Sheet(0.1f, 0.1f, 20, 20)), {}, options, {stroke});
    float least = 1e9f, most = -1e9f;
    for (int y = 90; y < 170; ++y) {
      const float height = map.height_mm[toys::At(map, 128, y)];
      least = std::min(least, height);
      most = std::max(most, height);
    }
    return most - least;
  };
  EXPECT_LT(variation(0.0f), 0.01f);
  EXPECT_GT(variation(0.3f), 0.1f);
}

}  // namespace
}  // namespace furrow::authoring

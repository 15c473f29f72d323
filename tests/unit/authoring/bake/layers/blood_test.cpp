// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/layers/blood.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "base/scalar.h"
#include "tests/unit/authoring/bake/toys.h"

namespace furrow::authoring {
namespace {

std::vector<float> Sum(const std::vector<std::vector<float>>& poses,
                       const std::vector<float>& weights) {
  BloodSum sum(poses[0].size());
  for (const std::vector<float>& growth : poses) sum.Add(growth, weights);
  return sum.Take();
}

TEST(Blood, AmountIsIndependentOfTheArea) {
  const std::vector<float> blood = Sum({{1.0f, 0.8f, 1.25f}}, {1.0f, 1.0f, 1.0f});
  EXPECT_FLOAT_EQ(blood[0], 1.0f);
  EXPECT_NEAR(blood[1], 1.25f, 1e-5f);
  EXPECT_NEAR(blood[2], 0.8f, 1e-5f);
}

TEST(Blood, FollowsThePoseWeightWithinLimits) {
  const std::vector<float> blood = Sum({{0.8f, 0.8f, 0.0f, 9.0f}}, {0.0f, 0.5f, 1.0f, 1.0f});
  EXPECT_FLOAT_EQ(blood[0], 1.0f);
  EXPECT_NEAR(blood[1], std::sqrt(1.25f), 1e-5f);
  EXPECT_NEAR(blood[2], 2.0f, 1e-5f);
  EXPECT_NEAR(blood[3], 0.5f, 1e-5f);
}

TEST(Blood, LargestChangeOfSeveralPosesWins) {
  const std::vector<float> blood = Sum({{0.8f, 0.8f}, {1.0f / 0.8f, 1.05f}}, {1.0f, 1.0f});
  EXPECT_NEAR(blood[0], 1.0f, 0.01f);  // the two changes cancel
  EXPECT_NEAR(blood[1], 1.25f, 1e-3f);
}

TEST(Blood, TintGrowsWithTheAmount) {
  EXPECT_EQ(BloodTint(1.0f), glm::vec3(1.0f));
  glm::vec3 before = BloodTint(0.5f);
  for (float blood = 0.6f; blood <= 2.0f; blood += 0.1f) {
    const glm::vec3 tint = BloodTint(blood);
    for (int c = 0; c < 3; ++c) {
      EXPECT_LT(tint[c], before[c]);
      EXPECT_LE(tint[c], kBloodTintScale);
    }
    EXPECT_GT(tint.r / tint.g, before.r / before.g);  // redder
    before = tint;
  }
}

TEST(Blood, IsPressedOutOfFurrows) {
  const float arm = BendArm(kOtherSkin);
  EXPECT_EQ(PressedOut(arm, 1.0f), 0.0f);
  EXPECT_FLOAT_EQ(PressedOut(arm, 0.2f), 0.2f);
  EXPECT_FLOAT_EQ(PressedOut(0.5f * arm, 0.2f), 0.1f);  // thinner skin
  EXPECT_FLOAT_EQ(PressedOut(10.0f * arm, 0.0f), 0.5f);
}

// A bar of the thickness d that is bent to the radius r is 1 + d / (2 r) times as long outside.
TEST(Blood, IsSpreadOnRidges) {
  const float d = 1.2f, below = 0.2f, r = 6.0f;
  const float wavelength = 8.0f;
  const float height = wavelength * wavelength / (4.0f * 9.8696f * r);  // of a sine with 1 / r
  const SkinSite skin{"", below, d - below};
  EXPECT_NEAR(RidgeStretch(BendArm(skin), height, wavelength), (0.5f * d - below) / r, 1e-4f);
  EXPECT_EQ(RidgeStretch(BendArm(skin), -height, wavelength), 0.0f);
  EXPECT_EQ(RidgeStretch(BendArm(skin), 100.0f, wavelength), 0.5f);
}

// The order of the sources that blood.h names.
TEST(Blood, OfRegionsFollowsTheMeasures) {
  const auto site = [](std::string_view region) {
    const auto found = std::ranges::find(kSkinSites, region, &SkinSite::region);
    EXPECT_NE(found, std::end(kSkinSites)) << region;
    return *found;
  };
  for (const SkinSite& other : kSkinSites) {
    EXPECT_GE(BendArm(other), BendArm(site("eye")));
    EXPECT_LE(other.blood, site("nose").blood);
    EXPECT_GE(other.blood, site("brow").blood);
  }
  // An eyelid has 56% of the skin of a forehead between its uppermost vessels and its middle.
  EXPECT_NEAR(BendArm(site("eye")) / BendArm(site("brow")), 0.225 / 0.4025, 1e-3);
}

// The pose makes the sheet narrower by a fifth.
BakedMap Squeezed(const character::Character& sheet, const BakeOptions& options) {
  return toys::BakeFolds(sheet, {toys::Pose(toys::Squeeze(0.2f, 30.0f))}, options);
}

TEST(Blood, BakedMapHasTheBloodOfItsPoses) {
  const character::Character sheet = toys::Wearing(toys::Sheet(0.1f, 0.1f, 10, 10));
  BakeOptions flat = toys::Exact();
  flat.skin.share = 0.0f;  // no folds
  const BakedMap map = Squeezed(sheet, flat);
  ASSERT_EQ(map.blood.size(), map.cavity.size());
  for (const float blood : map.blood) ASSERT_NEAR(blood, 1.25f, 1e-3f);
}

TEST(Blood, MovesFromFurrowsToTheSkinBeside) {
  const character::Character sheet = toys::Wearing(toys::Sheet(0.1f, 0.1f, 10, 10));
  const BakedMap map = Squeezed(sheet, toys::Exact());
  double amount = 0.0, flank = 0.0, valley = 2.0, ridge = 2.0;
  for (std::size_t i = 0; i < map.blood.size(); ++i) {
    const auto blood = static_cast<double>(map.blood[i]);
    const float wave = 2.0f * kPi / 10.0f;
    const float bend = std::max(map.height_mm[i], 0.0f) * wave * wave * BendArm(kOtherSkin);
    amount += blood * static_cast<double>(1.0f + bend) / static_cast<double>(map.blood.size());
    if (std::abs(map.height_mm[i]) < 0.05f) flank = std::max(flank, blood);
    if (map.height_mm[i] < 0.9f * -map.statistics.deepest_mm) valley = std::min(valley, blood);
    if (map.height_mm[i] > 0.9f * map.statistics.highest_mm) ridge = std::min(ridge, blood);
  }
  EXPECT_NEAR(amount, 1.25, 2e-3);  // none is lost
  EXPECT_GT(flank, 1.26);
  EXPECT_LT(valley, 1.22);
  EXPECT_LT(ridge, 1.22);
}

// Two halves of one sheet belong to a nose and to a forehead.
TEST(Blood, ChangesMoreWhereTheSkinHasMore) {
  character::Character sheet = toys::Wearing(toys::Sheet(0.1f, 0.1f, 10, 10));
  character::Picture masks{.name = "masks", .width = 2, .height = 1, .channels = 2};
  masks.pixels = {255, 0, 0, 255};
  sheet.rig_pictures.emplace_back(masks.name, static_cast<int>(sheet.pictures.size()));
  sheet.pictures.push_back(masks);
  wrinkle::Region region = sheet.rig.regions[0];
  sheet.rig.regions.clear();
  for (const char* name : {"nose", "brow_l"}) {
    region.name = name;
    region.mask.kind = wrinkle::Mask::Kind::kTexture;
    region.mask.texture = masks.name;
    region.mask.channel = static_cast<int>(sheet.rig.regions.size());
    sheet.rig.regions.push_back(region);
  }
  BakeOptions flat = toys::Exact();
  flat.skin.share = 0.0f;
  BakePose pose = toys::Pose(toys::Squeeze(0.2f, 30.0f));
  pose.region.clear();
  const BakedMap map = toys::BakeFolds(sheet, {pose}, flat);
  EXPECT_NEAR(map.blood[toys::At(map, 40, 100)], 1.0f + 1.2f * 0.25f, 1e-3f);
  EXPECT_NEAR(map.blood[toys::At(map, 215, 100)], 1.0f + 0.85f * 0.25f, 1e-3f);
}

}  // namespace
}  // namespace furrow::authoring

// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/cloth/cloth_strain.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "authoring/bake/cloth/sheet_math.h"
#include "tests/unit/authoring/bake/toys.h"

namespace furrow::authoring {
namespace {

using glm::mat3;
using glm::vec3;

constexpr float kStrainWidth = 0.4f, kStrainHeight = 0.1f;  // metres
constexpr float kFirst = 0.175f, kLast = 0.225f;            // of a band that is pressed along x
constexpr float kReach = 0.04f;                             // metres

class Strain : public testing::Test {
 protected:
  Strain() : mesh_(toys::Sheet(kStrainWidth, kStrainHeight, 40, 10)) {
    const character::Mesh* const meshes[] = {&mesh_};
    surface_ = std::make_unique<Surface>(meshes);
    fine_ = std::make_unique<FineMesh>(*surface_, 0.007f);
    cut_.assign(fine_->positions().begin(), fine_->positions().end());
  }

  // The band loses `share` of its length.
  [[nodiscard]] std::vector<vec3> Pressed(float share) const {
    std::vector<vec3> posed = cut_;
    for (vec3& p : posed) p.x -= share * (std::clamp(p.x, kFirst, kLast) - kFirst);
    return posed;
  }
  [[nodiscard]] std::vector<float> Room(float room = 1.0f) const {
    return std::vector<float>(cut_.size(), room);
  }
  // The mean of d T d for the unit vector d = `along`, at `from` to `to` along x.
  [[nodiscard]] double Mean(const std::vector<mat3>& tensors, const vec3& along, float from,
                            float to) const {
    double sum = 0.0, count = 0.0;
    for (std::size_t v = 0; v < cut_.size(); ++v) {
      if (cut_[v].x < from || cut_[v].x > to) continue;
      sum += static_cast<double>(glm::dot(along, tensors[v] * along));
      count += 1.0;
    }
    return sum / count;
  }
  [[nodiscard]] ClothStrain Measured(const std::vector<vec3>& posed, float room = 1.0f,
                                     float reach = kReach) const {
    return MeasureClothStrain(*fine_, cut_, posed, Room(room),
                              {.pressed = reach, .pulled = 0.5f * reach, .fed = 0.5f * reach});
  }

  character::Mesh mesh_;
  std::unique_ptr<Surface> surface_;
  std::unique_ptr<FineMesh> fine_;
  std::vector<vec3> cut_;
};

const vec3 kAcross(1, 0, 0), kUp(0, 1, 0);

TEST_F(Strain, SpreadsLostLengthAlongTheCompression) {
  const std::vector<mat3> lost = Measured(Pressed(0.6f)).lost;
  const double inside = Mean(lost, kAcross, kFirst + 0.015f, kLast - 0.015f);
  const double beside = Mean(lost, kAcross, kLast + 0.01f, kLast + 0.04f);
  EXPECT_GT(beside, 0.08);
  EXPECT_NEAR(Mean(lost, kAcross, kFirst - 0.04f, kFirst - 0.01f), beside, 0.2 * beside);
  EXPECT_GT(inside, 0.6 * beside);
  EXPECT_LT(inside, 0.5);
  EXPECT_LT(Mean(lost, kUp, kLast + 0.01f, kLast + 0.04f), 0.2 * beside);
  EXPECT_LT(Mean(lost, kAcross, kLast + 0.13f, kStrainWidth), 0.02 * beside);
}

TEST_F(Strain, KeepsTheLostLength) {
  const double whole = 0.6 * static_cast<double>(kLast - kFirst);
  for (const float reach : {0.0f, 0.02f, kReach}) {
    const std::vector<mat3> lost = Measured(Pressed(0.6f), 1.0f, reach).lost;
    EXPECT_NEAR(static_cast<double>(kStrainWidth) * Mean(lost, kAcross, 0.0f, kStrainWidth), whole,
                0.25 * whole);
  }
}

TEST_F(Strain, TellsPullFromCompression) {
  const ClothStrain pulled = Measured(Pressed(-0.2f));
  const double whole = 0.2 * static_cast<double>(kLast - kFirst);
  EXPECT_NEAR(static_cast<double>(kStrainWidth) * Mean(pulled.pulled, kAcross, 0.0f, kStrainWidth),
              whole, 0.25 * whole);
  EXPECT_NEAR(Mean(pulled.lost, kAcross, 0.0f, kStrainWidth), 0.0, 3e-3);
  EXPECT_NEAR(Mean(Measured(Pressed(0.6f)).pulled, kAcross, 0.0f, kStrainWidth), 0.0, 3e-3);
}

TEST_F(Strain, ClothBesideAPullFeedsIt) {
  const std::vector<vec3> posed = Pressed(-0.2f);
  const auto lost = [&](float fed, float from, float to, float feeds = 1.0f) {
    return Mean(MeasureClothStrain(*fine_, cut_, posed, Room(),
                                   {.pressed = kReach, .pulled = 0.01f, .fed = fed, .feeds = feeds})
                    .lost,
                kAcross, from, to);
  };
  EXPECT_GT(lost(0.05f, kLast + 0.02f, kLast + 0.06f), 0.01);
  EXPECT_GT(lost(0.05f, kLast + 0.02f, kLast + 0.06f),
            5.0 * lost(0.05f, kFirst + 0.015f, kLast - 0.015f));
  EXPECT_LT(lost(0.0f, kLast + 0.02f, kLast + 0.06f), 1e-3);
  EXPECT_NEAR(lost(0.05f, kLast + 0.02f, kLast + 0.06f, 0.5f),
              0.5 * lost(0.05f, kLast + 0.02f, kLast + 0.06f), 1e-3);
}

// Knitted cloth stretches by as much as it can, so less of it slips.
TEST_F(Strain, ClothThatStretchesIsPulledLess) {
  const auto measured = [&](float share, float stretches) {
    return MeasureClothStrain(
        *fine_, cut_, Pressed(-share), Room(),
        {.pressed = kReach, .pulled = 0.01f, .fed = 0.05f, .stretches = stretches});
  };
  const ClothStrain knitted = measured(0.1f, 0.125f);
  // At the ends of the band, single edges are pulled further.
  EXPECT_LT(Mean(knitted.pulled, kAcross, 0.0f, kStrainWidth), 1e-3);
  EXPECT_LT(Mean(knitted.lost, kAcross, 0.0f, kStrainWidth), 1e-3);
  const double woven = Mean(measured(0.3f, 0.0f).pulled, kAcross, 0.0f, kStrainWidth);
  const double left = Mean(measured(0.3f, 0.125f).pulled, kAcross, 0.0f, kStrainWidth);
  EXPECT_NEAR(left, woven * (0.3 - 0.125) / 0.3, 0.1 * woven);
}

// What feeds a pull is the part of the lost length that would not be lost without it.
TEST_F(Strain, TellsWhatFeedsAPull) {
  const auto measured = [&](float feeds) {
    return MeasureClothStrain(*fine_, cut_, Pressed(-0.2f), Room(),
                              {.pressed = kReach, .pulled = 0.01f, .fed = 0.05f, .feeds = feeds});
  };
  const ClothStrain feeding = measured(1.0f), still = measured(0.0f);
  ASSERT_EQ(feeding.fed.size(), cut_.size());
  float beside = 0.0f;
  for (std::size_t v = 0; v < cut_.size(); ++v) {
    EXPECT_EQ(still.fed[v], 0.0f);
    EXPECT_NEAR(feeding.fed[v], TraceOf(feeding.lost[v]) - TraceOf(still.lost[v]), 1e-4f);
    if (cut_[v].x > kLast + 0.02f && cut_[v].x < kLast + 0.06f) {
      beside = std::max(beside, feeding.fed[v]);
    }
    if (cut_[v].x > kLast + 0.15f) EXPECT_LT(feeding.fed[v], 1e-3f);
  }
  EXPECT_GT(beside, 0.02f);
}

TEST_F(Strain, IsZeroWithoutDeformationOrRoom) {
  std::vector<vec3> turned = cut_;
  for (vec3& p : turned) p = vec3(-p.y, p.x, 3.0f);
  for (const ClothStrain& strain : {Measured(turned), Measured(Pressed(0.6f), 0.0f)}) {
    ASSERT_EQ(strain.lost.size(), cut_.size());
    ASSERT_EQ(strain.pulled.size(), cut_.size());
    for (const vec3& along : {kAcross, kUp}) {
      EXPECT_NEAR(Mean(strain.lost, along, 0.0f, kStrainWidth), 0.0, 3e-3);
      EXPECT_NEAR(Mean(strain.pulled, along, 0.0f, kStrainWidth), 0.0, 3e-3);
    }
  }
}

TEST_F(Strain, SurvivesBrokenSkinning) {
  std::vector<vec3> point(cut_.size(), vec3(0.0f)), torn = cut_;
  for (std::size_t v = 0; v < torn.size(); v += 3) torn[v] *= 1e6f;
  for (const auto& posed : {point, torn}) {
    const ClothStrain strain = Measured(posed);
    for (const std::vector<mat3>* tensors : {&strain.lost, &strain.pulled}) {
      for (const mat3& tensor : *tensors) {
        for (int k = 0; k < 3; ++k) {
          EXPECT_TRUE(std::isfinite(glm::dot(tensor[k], tensor[k])));
          EXPECT_LT(glm::length(tensor[k]), 2.5f);
        }
      }
    }
  }
}

}  // namespace
}  // namespace furrow::authoring

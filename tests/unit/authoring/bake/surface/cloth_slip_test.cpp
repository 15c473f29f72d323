// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/surface/cloth_slip.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/unit/authoring/bake/toys.h"

namespace furrow::authoring {
namespace {

using glm::mat3;
using glm::vec3;

constexpr float kWidth = 0.4f, kHeight = 0.1f;    // metres
constexpr float kFirst = 0.175f, kLast = 0.225f;  // of a band that is pressed along x
constexpr float kReach = 0.04f;                   // metres

class Slip : public testing::Test {
 protected:
  Slip() : mesh_(toys::Sheet(kWidth, kHeight, 40, 10)) {
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
  // The mean gain along a direction, at `from` to `to` along x.
  [[nodiscard]] double Gain(const std::vector<mat3>& gained, const vec3& along, float from,
                            float to) const {
    double sum = 0.0, count = 0.0;
    for (std::size_t v = 0; v < cut_.size(); ++v) {
      if (cut_[v].x < from || cut_[v].x > to) continue;
      sum += static_cast<double>(glm::dot(along, gained[v] * along));
      count += 1.0;
    }
    return sum / count;
  }

  character::Mesh mesh_;
  std::unique_ptr<Surface> surface_;
  std::unique_ptr<FineMesh> fine_;
  std::vector<vec3> cut_;
};

TEST_F(Slip, GathersBesideTheBendAlongTheCompression) {
  const auto gained = SlippedLength(*fine_, cut_, Pressed(0.6f), Room(), kReach);
  const vec3 x(1, 0, 0), y(0, 1, 0);
  const double beside = Gain(gained, x, kLast + 0.01f, kLast + 0.04f);
  EXPECT_GT(beside, 0.08);
  EXPECT_NEAR(Gain(gained, x, kFirst - 0.04f, kFirst - 0.01f), beside, 0.2 * beside);
  EXPECT_LT(Gain(gained, y, kLast + 0.01f, kLast + 0.04f), 0.2 * beside);
  // The hollow has its own folds, and far away nothing arrives.
  EXPECT_LT(Gain(gained, x, kFirst + 0.015f, kLast - 0.015f), 0.1 * beside);
  EXPECT_LT(Gain(gained, x, kLast + 0.13f, kWidth), 0.02 * beside);
}

// The band loses 0.6 of 5 cm. About half of it stays in the band.
TEST_F(Slip, GivesNoMoreThanIsLost) {
  const auto gained = SlippedLength(*fine_, cut_, Pressed(0.6f), Room(), kReach);
  const double arrived = static_cast<double>(kWidth) * Gain(gained, vec3(1, 0, 0), 0.0f, kWidth);
  const double lost = 0.6 * static_cast<double>(kLast - kFirst);
  EXPECT_LT(arrived, lost);
  EXPECT_GT(arrived, 0.3 * lost);
}

TEST_F(Slip, NeedsCompressionRoomAndReach) {
  const std::vector<vec3> pressed = Pressed(0.6f);
  std::vector<vec3> pulled = Pressed(-0.2f), turned = cut_;
  for (vec3& p : turned) p = vec3(-p.y, p.x, 3.0f);
  for (const auto& gained : {SlippedLength(*fine_, cut_, turned, Room(), kReach),
                             SlippedLength(*fine_, cut_, pulled, Room(), kReach),
                             SlippedLength(*fine_, cut_, pressed, Room(0.0f), kReach),
                             SlippedLength(*fine_, cut_, pressed, Room(), 0.0f)}) {
    ASSERT_EQ(gained.size(), cut_.size());
    EXPECT_NEAR(Gain(gained, vec3(1, 0, 0), 0.0f, kWidth), 0.0, 3e-3);
    EXPECT_NEAR(Gain(gained, vec3(0, 1, 0), 0.0f, kWidth), 0.0, 3e-3);
  }
}

TEST_F(Slip, SurvivesBrokenSkinning) {
  std::vector<vec3> point(cut_.size(), vec3(0.0f)), torn = cut_;
  for (std::size_t v = 0; v < torn.size(); v += 3) torn[v] *= 1e6f;
  for (const auto& posed : {point, torn}) {
    for (const mat3& gain : SlippedLength(*fine_, cut_, posed, Room(), kReach)) {
      for (int k = 0; k < 3; ++k) {
        EXPECT_TRUE(std::isfinite(glm::dot(gain[k], gain[k])));
        EXPECT_LT(glm::length(gain[k]), 2.0f);
      }
    }
  }
}

}  // namespace
}  // namespace furrow::authoring

// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/cloth/crease_relief.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/unit/authoring/bake/toys.h"

namespace furrow::authoring {
namespace {

using glm::vec3;

// A sheet of 20 x 20 cm, and creases on it.
class Relief : public testing::Test {
 protected:
  Relief() : mesh_(toys::Sheet(0.2f, 0.2f, 10, 10)) {
    const character::Mesh* const meshes[] = {&mesh_};
    surface_ = std::make_unique<Surface>(meshes);
    fine_ = std::make_unique<FineMesh>(*surface_, 0.003f);
  }

  // A crease along y at `x`, 14 cm long, `half` to each side.
  [[nodiscard]] static Crease At(float x, float half, float excess, float end_strength = 1.0f) {
    Crease crease;
    for (int i = 0; i <= 28; ++i) {
      const float t = static_cast<float>(i) / 28.0f;
      const float strength = std::lerp(1.0f, end_strength, std::abs(2.0f * t - 1.0f));
      crease.points.push_back({.place = {x, 0.03f + 0.14f * t, 0.0f},
                               .normal = {0, 0, 1},
                               .along = {0, 1, 0},
                               .excess = excess,
                               .spacing = 2.0f * half,
                               .left = half,
                               .right = half,
                               .strength = strength});
    }
    return crease;
  }
  // The largest height near a place.
  [[nodiscard]] float HeightNear(const std::vector<float>& heights, const vec3& place,
                                 float radius = 0.004f) const {
    float most = 0.0f;
    for (std::size_t v = 0; v < heights.size(); ++v) {
      if (glm::distance(fine_->positions()[v], place) < radius) most = std::max(most, heights[v]);
    }
    return most;
  }

  character::Mesh mesh_;
  std::unique_ptr<Surface> surface_;
  std::unique_ptr<FineMesh> fine_;
};

TEST_F(Relief, IsFlatWithoutCreasesOrExcess) {
  for (const std::vector<Crease>& creases :
       {std::vector<Crease>(), std::vector<Crease>{At(0.1f, 0.02f, 0.0f)}}) {
    for (const float height : DrawCreases(*fine_, creases, {})) EXPECT_EQ(height, 0.0f);
  }
}

TEST_F(Relief, GrowsWithTheExcess) {
  float last = 0.0f;
  for (const float excess : {0.05f, 0.1f, 0.2f, 0.35f, 0.6f}) {
    const std::vector<Crease> one = {At(0.1f, 0.02f, excess)};
    const float height = HeightNear(DrawCreases(*fine_, one, {}), {0.1f, 0.1f, 0.0f});
    EXPECT_GT(height, 1.05f * last) << excess;
    EXPECT_LE(height, CrestHeight(0.04f, 0.04f * excess, 0.04f, {}) + 1e-6f);
    last = height;
  }
}

TEST_F(Relief, IsNeverTooSteep) {
  const ReliefOptions options;
  for (const float w : {0.02f, 0.05f, 0.1f}) {
    EXPECT_LE(CrestHeight(w, 0.8f * w, w, options), 0.25f * options.steepest * w);
    EXPECT_GT(CrestHeight(w, 0.4f * w, w, options), CrestHeight(w, 0.3f * w, w, options));
  }
}

TEST_F(Relief, EndsWhereACreaseEnds) {
  const std::vector<float> heights =
      DrawCreases(*fine_, std::vector<Crease>{At(0.1f, 0.02f, 0.3f, 0.0f)}, {});
  const float middle = HeightNear(heights, {0.1f, 0.1f, 0.0f});
  const float near_end = HeightNear(heights, {0.1f, 0.05f, 0.0f});
  EXPECT_GT(near_end, 0.1f * middle);
  EXPECT_LT(near_end, 0.7f * middle);
  EXPECT_LT(HeightNear(heights, {0.1f, 0.028f, 0.0f}), 0.1f * middle);
  // Depth and width fade together.
  EXPECT_GT(HeightNear(heights, {0.1f + 0.014f, 0.1f, 0.0f}), 0.2f * middle);
  EXPECT_LT(HeightNear(heights, {0.1f + 0.014f, 0.05f, 0.0f}), 0.06f * middle);
}

TEST_F(Relief, HasFlatsBetweenShallowCrestsAndValleysBetweenDeepOnes) {
  const auto valley = [&](float excess, float half) {
    const std::vector<Crease> two = {At(0.08f, half, excess), At(0.12f, half, excess)};
    const std::vector<float> heights = DrawCreases(*fine_, two, {});
    return HeightNear(heights, {0.1f, 0.1f, 0.0f}, 0.0025f) /
           HeightNear(heights, {0.08f, 0.1f, 0.0f});
  };
  EXPECT_LT(valley(0.05f, 0.015f), 0.01f);
  EXPECT_GT(valley(0.4f, 0.024f), 0.1f);
  EXPECT_LT(valley(0.4f, 0.024f), 0.7f);
}

}  // namespace
}  // namespace furrow::authoring

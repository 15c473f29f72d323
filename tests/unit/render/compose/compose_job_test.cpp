// SPDX-License-Identifier: Apache-2.0
#include "render/compose/compose_job.h"

#include <functional>
#include <random>

#include <glm/gtc/packing.hpp>
#include <glm/vec4.hpp>
#include <gtest/gtest.h>

namespace furrow::render {
namespace {

constexpr std::size_t kTexels = ComposeTile::kTexels;
constexpr std::size_t kMaps = 3;
constexpr std::size_t kChannels = 5;

float Plane(const std::vector<std::uint16_t>& halves, std::size_t plane, std::size_t texel) {
  return glm::unpackHalf1x16(halves[plane * kTexels + texel]);
}

class ComposeJobTest : public testing::Test {
 protected:
  ComposeJobTest() {
    tile_.slopes = Planes(3, 0.0f, 0.8f);
    tile_.colour = Planes(3, 0.1f, 0.9f);
    tile_.cavity_albedo = 0.3f;
    for (std::size_t map = 0; map < kMaps; ++map) {
      tile_.maps.push_back({Planes(3, 0.0f, 1.0f), Planes(4, 0.2f, 1.0f)});
    }
    tile_.maps[1].looks.clear();  // some maps have no looks
    for (const std::size_t channel : {0u, 2u, 4u, 1u, 3u}) {
      auto& masks = channel % 2 == 0 ? tile_.masks : tile_.skinned;
      ComposeTile::Mask& mask = masks.emplace_back();
      mask.channel = channel;
      for (std::size_t i = 0; i < kTexels; ++i) {
        mask.values.push_back(static_cast<std::uint8_t>(random_() % 256));
      }
    }
    for (std::size_t i = 0; i < kChannels * kMaps; ++i)
      strengths_.weights.push_back(Random(0.05f, 1.0f));
    strengths_.weights[7] = 0.0f;
    strengths_.weights[2] = -1.0f;  // a weight of unknown state, which paints nothing
    strengths_.amplitudes = {1.0f, 0.5f, 2.0f};
    strengths_.scales = {1.0f, 1.0f, 1.5f};
    strengths_.looks = {0.8f, 1.2f};
    job_ = {&tile_, &strengths_, slopes_, colours_};
  }

  float Random(float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(random_);
  }
  std::vector<std::uint16_t> Planes(std::size_t planes, float low, float high) {
    std::vector<std::uint16_t> halves;
    for (std::size_t i = 0; i < planes * kTexels; ++i) {
      halves.push_back(glm::packHalf1x16(Random(low, high)));
    }
    return halves;
  }
  float Sum(const std::vector<ComposeTile::Mask>& masks, std::size_t map, std::size_t texel) const {
    float sum = 0.0f;
    for (const ComposeTile::Mask& mask : masks) {
      const float weight = std::max(strengths_.weights[mask.channel * kMaps + map], 0.0f);
      sum += weight * static_cast<float>(mask.values[texel]) / 255.0f;
    }
    return sum;
  }
  float Coefficient(std::size_t map, std::size_t texel) const {
    return Sum(tile_.masks, map, texel) + std::min(Sum(tile_.skinned, map, texel), 1.0f);
  }
  glm::vec4 Slope(std::size_t texel) const {
    glm::vec3 sum(0.0f);
    for (int k = 0; k < 3; ++k) sum[k] = Plane(tile_.slopes, static_cast<std::size_t>(k), texel);
    for (std::size_t map = 0; map < kMaps; ++map) {
      const float w = strengths_.amplitudes[map] * Coefficient(map, texel);
      const std::vector<std::uint16_t>& slopes = tile_.maps[map].slopes;
      sum += glm::vec3(w * Plane(slopes, 0, texel), w * Plane(slopes, 1, texel),
                       w * w * Plane(slopes, 2, texel));
    }
    return {sum.x, sum.y, sum.x * sum.x + sum.z, sum.y * sum.y + sum.z};
  }
  glm::vec4 Colour(std::size_t texel) const {
    glm::vec4 look(1.0f);
    for (int k = 0; k < 4; ++k) {
      const auto plane = static_cast<std::size_t>(k);
      for (std::size_t map = 0; map < kMaps; ++map) {
        if (tile_.maps[map].looks.empty()) continue;
        const float value = Plane(tile_.maps[map].looks, plane, texel);
        const float scale = k < 3 ? strengths_.scales[map] : 1.0f;
        const float strength = k < 3 ? strengths_.looks.x : strengths_.looks.y;
        look[k] *=
            std::max(1.0f + strength * Coefficient(map, texel) * (scale * value - 1.0f), 0.0f);
      }
      if (k < 3) look[k] *= Plane(tile_.colour, plane, texel);
    }
    look.g = std::max(look.g, std::min(Plane(tile_.colour, 1, texel), tile_.cavity_albedo));
    return look;
  }
  static void ExpectTexels(const std::vector<std::uint16_t>& halves,
                           const std::function<glm::vec4(std::size_t)>& expected) {
    for (std::size_t i = 0; i < kTexels; ++i) {
      const glm::vec4 texel = expected(i);
      for (int k = 0; k < 4; ++k) {
        const float value = glm::unpackHalf1x16(halves[4 * i + static_cast<std::size_t>(k)]);
        // The tolerance is half a unit in the last place of a half float, plus a little for the
        // order of summation.
        ASSERT_NEAR(value, texel[k], std::abs(texel[k]) * 5.2e-4f + 1e-5f) << i << " " << k;
      }
    }
  }

  std::mt19937 random_{3};
  ComposeTile tile_;
  ComposeStrengths strengths_;
  std::vector<std::uint16_t> slopes_ = std::vector<std::uint16_t>(4 * kTexels);
  std::vector<std::uint16_t> colours_ = std::vector<std::uint16_t>(4 * kTexels);
  ComposeJob job_;
};

TEST_F(ComposeJobTest, MatchesTheFormulaTexelByTexel) {
  ASSERT_TRUE(job_.Run());
  ExpectTexels(slopes_, [&](std::size_t texel) { return Slope(texel); });
  ExpectTexels(colours_, [&](std::size_t texel) { return Colour(texel); });
}

// The job must not touch the texels of neighbouring tiles.
TEST_F(ComposeJobTest, WritesRowsAtTheGivenStride) {
  ASSERT_TRUE(job_.Run());
  constexpr std::size_t kStride = 100;
  std::vector<std::uint16_t> wide(4 * kStride * ComposeTile::kSide, 7);
  tile_.colour.clear();
  ComposeJob job{&tile_, &strengths_, std::span(wide).subspan(4 * 3), {}, kStride};
  ASSERT_TRUE(job.Run());
  for (std::size_t i = 0; i < wide.size(); ++i) {
    const std::size_t x = i / 4 % kStride - 3;
    const std::size_t y = i / 4 / kStride;
    const bool is_inside = i / 4 % kStride >= 3 && x < ComposeTile::kSide;
    const std::size_t in_tile = 4 * (y * ComposeTile::kSide + x) + i % 4;
    ASSERT_EQ(wide[i], is_inside ? slopes_[in_tile] : 7) << i;
  }
}

TEST_F(ComposeJobTest, WithoutWeightsWritesTheBaseSurface) {
  std::fill(strengths_.weights.begin(), strengths_.weights.end(), 0.0f);
  tile_.colour.clear();
  job_.colours = {};
  ASSERT_TRUE(job_.Run());
  for (std::size_t i = 0; i < kTexels; ++i) {
    ASSERT_EQ(slopes_[4 * i], tile_.slopes[i]);
    ASSERT_EQ(slopes_[4 * i + 1], tile_.slopes[kTexels + i]);
  }
}

TEST_F(ComposeJobTest, RejectsInconsistentInput) {
  const auto refused =
      [&](const std::function<void(ComposeTile*, ComposeStrengths*, ComposeJob*)>& spoil) {
        ComposeTile tile = tile_;
        ComposeStrengths strengths = strengths_;
        ComposeJob job{&tile, &strengths, slopes_, colours_};
        spoil(&tile, &strengths, &job);
        return !job.Run();
      };
  EXPECT_FALSE(refused([](ComposeTile*, ComposeStrengths*, ComposeJob*) {}));
  EXPECT_TRUE(
      refused([](ComposeTile*, ComposeStrengths*, ComposeJob* job) { job->tile = nullptr; }));
  EXPECT_TRUE(
      refused([](ComposeTile*, ComposeStrengths*, ComposeJob* job) { job->strengths = nullptr; }));
  EXPECT_TRUE(refused([](ComposeTile*, ComposeStrengths*, ComposeJob* job) { job->colours = {}; }));
  EXPECT_TRUE(refused([](ComposeTile*, ComposeStrengths*, ComposeJob* job) {
    job->slopes = job->slopes.subspan(1);
  }));
  EXPECT_TRUE(refused([](ComposeTile*, ComposeStrengths*, ComposeJob* job) { --job->stride; }));
  EXPECT_TRUE(refused([](ComposeTile*, ComposeStrengths*, ComposeJob* job) { ++job->stride; }));
  EXPECT_TRUE(
      refused([](ComposeTile* tile, ComposeStrengths*, ComposeJob*) { tile->maps.clear(); }));
  EXPECT_TRUE(
      refused([](ComposeTile* tile, ComposeStrengths*, ComposeJob*) { tile->slopes.pop_back(); }));
  EXPECT_TRUE(
      refused([](ComposeTile* tile, ComposeStrengths*, ComposeJob*) { tile->colour.pop_back(); }));
  EXPECT_TRUE(refused(
      [](ComposeTile* tile, ComposeStrengths*, ComposeJob*) { tile->maps[1].slopes.pop_back(); }));
  EXPECT_TRUE(refused(
      [](ComposeTile* tile, ComposeStrengths*, ComposeJob*) { tile->maps[2].looks.pop_back(); }));
  EXPECT_TRUE(refused(
      [](ComposeTile* tile, ComposeStrengths*, ComposeJob*) { tile->masks[0].values.pop_back(); }));
  EXPECT_TRUE(refused([](ComposeTile* tile, ComposeStrengths*, ComposeJob*) {
    tile->masks[2].channel = kChannels;
  }));
  EXPECT_TRUE(refused([](ComposeTile* tile, ComposeStrengths*, ComposeJob*) {
    tile->skinned[1].channel = kChannels;
  }));
  EXPECT_TRUE(refused([](ComposeTile*, ComposeStrengths* strengths, ComposeJob*) {
    strengths->weights.pop_back();
  }));
  EXPECT_TRUE(refused([](ComposeTile*, ComposeStrengths* strengths, ComposeJob*) {
    strengths->amplitudes.pop_back();
  }));
  EXPECT_TRUE(refused([](ComposeTile*, ComposeStrengths* strengths, ComposeJob*) {
    strengths->scales.pop_back();
  }));
}

}  // namespace
}  // namespace furrow::render

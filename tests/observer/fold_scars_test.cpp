// SPDX-License-Identifier: Apache-2.0
#include "tests/observer/fold_scars.h"

#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>
#include <gtest/gtest.h>

#include "base/scalar.h"

namespace furrow::observer {
namespace {

using glm::vec2;
using glm::vec3;

constexpr float kSide = 0.5f;        // millimetres between places
constexpr float kPatchSize = 60.0f;  // millimetres
constexpr float kWavelength = 6.0f;  // millimetres

using Height = std::function<float(const vec2&)>;

// A flat sheet that is compressed by a fifth along x, with a relief.
FoldPatch Sheet(const Height& height) {
  FoldPatch patch;
  patch.wavelength = static_cast<double>(kWavelength);
  constexpr float kStep = 0.01f;
  for (float y = 0.0f; y < kPatchSize; y += kSide) {
    for (float x = 0.0f; x < kPatchSize; x += kSide) {
      const vec2 p(x, y);
      const auto slope = [&](const vec2& step) {
        return (height(p + step) - height(p - step)) / (2.0f * kStep);
      };
      FoldPlace place;
      place.position = vec3(p, 0.0f);
      place.area = kSide * kSide;
      place.height = height(p);
      place.slope = vec3(slope({kStep, 0.0f}), slope({0.0f, kStep}), 0.0f);
      place.compression = 0.2f;
      patch.places.push_back(place);
    }
  }
  return patch;
}

// Folds across the direction at `degrees` from x, 0.6 mm from valley to ridge. They are not quite
// parallel: they turn by 10 degrees to either side.
Height Folds(float degrees) {
  const vec2 across(std::cos(glm::radians(degrees)), std::sin(glm::radians(degrees)));
  return [across](const vec2& p) {
    const float at = glm::dot(p, across);
    const float along = across.x * p.y - across.y * p.x;
    const float sway = 0.17f * 20.0f / 1.57f * std::sin(along / 20.0f * 1.57f);
    return 0.3f * std::cos(2.0f * kPi * (at + sway) / kWavelength);
  };
}

struct Scratch {
  vec2 middle;
  vec2 along;  // unit
  float half_length;
  float depth;
};

// Valleys of 2 mm, as a cut leaves them.
Height Scratches(const std::vector<Scratch>& scratches) {
  return [scratches](const vec2& p) {
    float height = 0.0f;
    for (const Scratch& one : scratches) {
      const vec2 away = p - one.middle;
      const float along = glm::dot(away, one.along) / one.half_length;
      const float across = one.along.x * away.y - one.along.y * away.x;
      if (std::abs(along) >= 1.0f) continue;
      height -= one.depth * (1.0f - along * along) * std::exp(-across * across);
    }
    return height;
  };
}

// Scratches of 8 mm, 20 mm apart, at random angles.
std::vector<Scratch> Wounds(float depth) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> angle(0.0f, kPi);
  std::vector<Scratch> wounds;
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 3; ++x) {
      const float a = angle(random);
      wounds.push_back(
          {{10.0f + 20.0f * static_cast<float>(x), 10.0f + 20.0f * static_cast<float>(y)},
           {std::cos(a), std::sin(a)},
           4.0f,
           depth});
    }
  }
  return wounds;
}

TEST(MeasureScars, FindsNoneInFoldsAcrossTheCompression) {
  const ScarMeasures measures = MeasureScars(Sheet(Folds(0.0f)));
  EXPECT_LT(measures.against, 0.01);
  EXPECT_LT(measures.disordered, 0.01);
  EXPECT_EQ(measures.isolated, 0.0);
  EXPECT_EQ(measures.short_deep, 0.0);
  EXPECT_EQ(measures.hard, 0.0);
  EXPECT_TRUE(IsWithin(measures, kScarLimits));
}

TEST(MeasureScars, FindsNoneWithoutFolds) {
  const ScarMeasures measures = MeasureScars(Sheet([](const vec2&) { return 0.0f; }));
  EXPECT_TRUE(IsWithin(measures, ScarMeasures()));
  EXPECT_TRUE(IsWithin(MeasureScars(FoldPatch()), ScarMeasures()));
}

TEST(MeasureScars, FindsFoldsAlongTheCompression) {
  EXPECT_LT(MeasureScars(Sheet(Folds(30.0f))).against, 0.1);
  EXPECT_GT(MeasureScars(Sheet(Folds(60.0f))).against, 0.9);
  const ScarMeasures along = MeasureScars(Sheet(Folds(90.0f)));
  EXPECT_GT(along.against, 0.99);
  EXPECT_LT(along.disordered, 0.01);  // parallel all the same
  EXPECT_FALSE(IsWithin(along, kScarLimits));
}

TEST(MeasureScars, CountsDrawnFoldsApart) {
  FoldPatch patch = Sheet(Folds(90.0f));
  for (FoldPlace& place : patch.places) place.drawn = place.position.x < 15.0f;
  const ScarMeasures measures = MeasureScars(patch);
  EXPECT_NEAR(measures.against, 0.75, 0.03);
  EXPECT_NEAR(measures.drawn_against, 0.25, 0.03);
}

TEST(MeasureScars, IgnoresDirectionsWithoutAClearCompression) {
  FoldPatch even = Sheet(Folds(90.0f));
  for (FoldPlace& place : even.places) place.crossing = 0.15f;
  EXPECT_EQ(MeasureScars(even).against, 0.0);
  FoldPatch slack = Sheet(Folds(90.0f));
  for (FoldPlace& place : slack.places) place.compression = 0.05f;
  EXPECT_EQ(MeasureScars(slack).against, 0.0);
}

// Folds in both directions, as a crumpled sheet has them.
TEST(MeasureScars, FindsDisorder) {
  const Height crumpled = [](const vec2& p) { return Folds(0.0f)(p) + Folds(90.0f)(p); };
  EXPECT_GT(MeasureScars(Sheet(crumpled)).disordered, 0.99);
  EXPECT_FALSE(IsWithin(MeasureScars(Sheet(crumpled)), kScarLimits));
}

TEST(MeasureScars, FindsIsolatedFurrows) {
  const ScarMeasures measures = MeasureScars(Sheet(Scratches(Wounds(0.4f))));
  EXPECT_EQ(measures.isolated, 1.0);
  EXPECT_EQ(measures.short_deep, 0.0);  // not deep
  EXPECT_FALSE(IsWithin(measures, kScarLimits));
  EXPECT_EQ(MeasureScars(Sheet(Scratches(Wounds(0.1f)))).isolated, 0.0);  // too shallow to show
}

TEST(MeasureScars, AllowsWhatAStrokeDraws) {
  FoldPatch patch = Sheet(Scratches(Wounds(1.0f)));
  EXPECT_EQ(MeasureScars(patch).isolated, 1.0);
  EXPECT_EQ(MeasureScars(patch).short_deep, 1.0);
  for (FoldPlace& place : patch.places) place.drawn = place.position.x < 20.0f;
  EXPECT_NEAR(MeasureScars(patch).isolated, 2.0 / 3.0, 0.05);
  EXPECT_NEAR(MeasureScars(patch).short_deep, 2.0 / 3.0, 0.05);
}

// Three short furrows beside each other, as crow's feet, and the same far apart.
TEST(MeasureScars, AllowsShortFurrowsBesideEachOther) {
  const auto three = [](float distance) {
    std::vector<Scratch> furrows;
    for (const float x : {-1.0f, 0.0f, 1.0f}) {
      furrows.push_back({{30.0f + distance * x, 30.0f}, {0.0f, 1.0f}, 8.0f, 0.4f});
    }
    return Sheet(Scratches(furrows));
  };
  EXPECT_EQ(MeasureScars(three(7.0f)).isolated, 0.0);
  EXPECT_EQ(MeasureScars(three(14.0f)).isolated, 1.0);
}

// A furrow as long as a brow may be alone.
TEST(MeasureScars, AllowsOneLongFurrow) {
  const auto one = [](float half_length) {
    return Sheet(Scratches({{{30.0f, 30.0f}, {0.0f, 1.0f}, half_length, 0.4f}}));
  };
  EXPECT_EQ(MeasureScars(one(20.0f)).isolated, 0.0);
  EXPECT_EQ(MeasureScars(one(8.0f)).isolated, 1.0);
}

// Ridges with the radius 4 / (2 pi)^2 / 0.1 mm at their crests.
TEST(MeasureScars, FindsHardRims) {
  const auto ridges = [](float amplitude) {
    return MeasureScars(Sheet([amplitude](const vec2& p) {
             return amplitude * std::cos(2.0f * kPi * p.x / 4.0f);
           }))
        .hard;
  };
  EXPECT_EQ(ridges(0.35f), 0.0);  // 1.16 mm
  EXPECT_GT(ridges(0.6f), 0.15);  // 0.68 mm
  // A valley may be sharp: the same ridges upside down between gentle ones.
  const auto valleys = [](const vec2& p) {
    const float wave = std::cos(2.0f * kPi * p.x / 4.0f);
    return wave > 0.0f ? 0.3f * wave : 0.6f * wave;
  };
  EXPECT_LT(MeasureScars(Sheet(valleys)).hard, 0.05);
  // Flat skin whose stored heights are not quite 0 does not count as a ridge.
  const auto half = [](const vec2& p) {
    return p.x < 30.0f ? 0.6f * std::cos(2.0f * kPi * p.x / 4.0f) : 1e-4f;
  };
  EXPECT_GT(MeasureScars(Sheet(half)).hard, 0.15);
}

}  // namespace
}  // namespace furrow::observer

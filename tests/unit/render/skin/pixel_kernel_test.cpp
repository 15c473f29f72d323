// SPDX-License-Identifier: Apache-2.0
#include "render/skin/pixel_kernel.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace furrow::render {
namespace {

constexpr double kWindow = 8.0;  // mm to either side of an edge, for errors
constexpr float kScales[] = {0.3f, 0.5f, 0.8f,  1.0f,  1.5f,  2.4f, 3.0f,
                             5.0f, 8.0f, 12.0f, 16.0f, 24.0f, 40.0f};  // pixels per mm
constexpr double kTailLeftOut = 1.5e-4;  // RMSE from the response beyond a kernel's reach
constexpr int kTaps[] = {11, 17, 25};

// Sum and variance (pixels^2) of a kernel along one axis of the picture, over both passes.
struct Moments {
  glm::dvec3 sum{0.0};
  glm::dvec3 variance{0.0};
};

Moments MomentsOf(const PixelTaps& kernel) {
  Moments moments;
  for (std::size_t i = 0; i < kernel.weights.size(); ++i) {
    const glm::dvec3 weight = (i == 0 ? 1.0 : 2.0) * glm::dvec3(kernel.weights[i]);
    const glm::dvec2 offset(kernel.offsets[i]);
    moments.sum += weight;
    moments.variance += weight * glm::dot(offset, offset);
  }
  return moments;
}

TEST(PixelKernel, SumsToOneOnDistinctWholePixels) {
  for (const int taps : kTaps) {
    for (const float pixels_per_mm : {0.05f, 0.3f, 1.0f, 2.4f, 8.0f, 40.0f}) {
      const PixelTaps kernel = PixelKernel(HumanSkin(), taps, pixels_per_mm);
      ASSERT_FALSE(kernel.weights.empty());
      ASSERT_EQ(kernel.offsets.size(), kernel.weights.size());
      EXPECT_LE(2 * kernel.weights.size() - 1, static_cast<std::size_t>(taps));
      const Moments moments = MomentsOf(kernel);
      for (int channel = 0; channel < 3; ++channel) {
        EXPECT_NEAR(moments.sum[channel], 1.0, 1e-5) << taps << " " << pixels_per_mm;
        for (const glm::vec3& weight : kernel.weights) EXPECT_GE(weight[channel], 0.0f);
      }
      EXPECT_EQ(kernel.offsets[0], glm::vec2(0.0f));
      for (std::size_t i = 1; i < kernel.offsets.size(); ++i) {
        const glm::vec2 offset = kernel.offsets[i];
        EXPECT_GT(offset.x, kernel.offsets[i - 1].x);
        EXPECT_EQ(offset, glm::round(offset));
        EXPECT_LT(offset.y, 0.5f * (offset.x - kernel.offsets[i - 1].x));
        EXPECT_GE(offset.y, 0.0f);
      }
    }
  }
}

TEST(PixelKernel, TapCountsAreRoundedIntoRange) {
  EXPECT_EQ(PixelKernel(HumanSkin(), 0, 8.0f).weights.size(), 1u + kMinSeparableTaps / 2);
  EXPECT_EQ(PixelKernel(HumanSkin(), 12, 8.0f).weights.size(), 7u);
  EXPECT_EQ(PixelKernel(HumanSkin(), 999, 8.0f).weights.size(), 1u + kMaxSeparableTaps / 2);
}

TEST(PixelKernel, GetsShorterWithWiderPixels) {
  EXPECT_EQ(PixelKernel(HumanSkin(), 17, 0.01f).weights.size(), 1u);
  EXPECT_LT(PixelKernel(HumanSkin(), 17, 0.5f).weights.size(), 9u);
  EXPECT_EQ(PixelKernel(HumanSkin(), 17, 5.0f).weights.size(), 9u);
}

// The published demo's kernel has a red variance of 0.755 mm^2; the profile's is 1.383 mm^2.
TEST(PixelKernel, KeepsMostOfTheVariance) {
  for (const auto& [taps, least] : {std::pair(11, 1.09), {17, 1.22}, {25, 1.30}}) {
    const double variance = MomentsOf(PixelKernel(HumanSkin(), taps, 8.0f)).variance.r / 64.0;
    EXPECT_GT(variance, least) << taps;
    EXPECT_LT(variance, 1.383) << taps;
  }
}

// A straight edge after both passes at a distance of `mm`, positive on the lit side. `turned`:
// angle between the edge's normal and the picture's x axis.
class Edge {
 public:
  Edge(const PixelTaps& kernel, double pixels_per_mm, double turned) {
    const glm::dvec2 normal(std::cos(turned), std::sin(turned));
    const glm::dvec2 turned_normal(normal.y, -normal.x);
    for (const Tap& a : BothSides(kernel, normal)) {
      for (const Tap& b : BothSides(kernel, turned_normal)) {
        taps_.push_back({(a.mm + b.mm) / pixels_per_mm, a.weight * b.weight});
      }
    }
    // Prefix sums from the outermost tap inwards, which make each query a look-up.
    std::sort(taps_.begin(), taps_.end(), [](const Tap& a, const Tap& b) { return a.mm > b.mm; });
    for (std::size_t i = 1; i < taps_.size(); ++i) taps_[i].weight += taps_[i - 1].weight;
  }

  // Root mean square error over kWindow and the channels, at the centres of `samples` per mm.
  // `soft`: width in mm of the transition from dark to light.
  [[nodiscard]] double Rmse(double samples, double soft) const {
    constexpr int kParts = 8;
    const int count = static_cast<int>(kWindow * samples);
    double sum = 0.0;
    for (int i = -count; i < count; ++i) {
      const double mm = (i + 0.5) / samples;
      glm::dvec3 error = -glm::dvec3(StepResponse(HumanSkin(), mm));
      for (int part = 0; part < kParts; ++part) {
        error += At(mm + soft * ((part + 0.5) / kParts - 0.5)) / static_cast<double>(kParts);
      }
      sum += glm::dot(error, error);
    }
    return std::sqrt(sum / (6.0 * count));
  }

 private:
  struct Tap {
    double mm = 0.0;  // pixels in BothSides()
    glm::dvec3 weight{0.0};
  };
  static std::vector<Tap> BothSides(const PixelTaps& kernel, const glm::dvec2& normal) {
    std::vector<Tap> taps;
    for (std::size_t i = 0; i < kernel.weights.size(); ++i) {
      const double along = glm::dot(glm::dvec2(kernel.offsets[i]), normal);
      taps.push_back({along, glm::dvec3(kernel.weights[i])});
      if (i > 0) taps.push_back({-along, glm::dvec3(kernel.weights[i])});
    }
    return taps;
  }
  [[nodiscard]] glm::dvec3 At(double mm) const {
    const auto unlit = std::partition_point(taps_.begin(), taps_.end(),
                                            [mm](const Tap& tap) { return tap.mm > -mm; });
    return unlit == taps_.begin() ? glm::dvec3(0.0) : std::prev(unlit)->weight;
  }
  std::vector<Tap> taps_;
};

// A straight edge along the picture's columns, sampled at its pixels.
double EdgeError(const PixelTaps& kernel, double pixels_per_mm) {
  return Edge(kernel, pixels_per_mm, 0.0).Rmse(pixels_per_mm, 0.0);
}

// A simple alternative kernel: taps on the axis at quadratically growing distances, with the best
// reach for 11 to 25 taps, and for each tap the share of the profile nearest to it.
PixelTaps MidpointKernel(int taps, double pixels_per_mm) {
  const int pairs = taps / 2;
  const double reach = 3.0 + 0.1 * (taps - 11);  // mm
  PixelTaps kernel;
  for (int i = 0; i <= pairs; ++i) {
    const double place = std::round(reach * pixels_per_mm * i * i / (pairs * pairs));
    const double own = i == 0 ? 0.0 : std::max(place, kernel.offsets.back().x + 1.0);
    kernel.offsets.emplace_back(own, 0.0);
  }
  glm::vec3 inside(0.5f);
  for (int i = 0; i <= pairs; ++i) {
    const double border =
        i == pairs ? 1e3 : 0.5 * (kernel.offsets[i].x + kernel.offsets[i + 1].x) / pixels_per_mm;
    const glm::vec3 share = StepResponse(HumanSkin(), border);
    kernel.weights.push_back((i == 0 ? 2.0f : 1.0f) * (share - inside));
    inside = share;
  }
  return kernel;
}

// Smallest possible error of a staircase with many freely placed steps. For `pairs` steps and a
// curve of slope s it is sqrt(integral of s^(2/3))^3 / 12) / pairs (Panter and Dite 1951).
double StaircaseError(int pairs) {
  constexpr double kStep = 1e-3;  // mm
  double sum = 0.0;
  for (double x = 0.5 * kStep; x < kWindow; x += kStep) {
    sum += std::pow(glm::length(glm::dvec3(LineProfile(HumanSkin(), x))), 2.0 / 3.0) * kStep;
  }
  return std::sqrt(sum * sum * sum / 12.0 / (3.0 * kWindow)) / pairs;
}

TEST(PixelKernel, AnEdgeKeepsItsResponseAtEveryScale) {
  for (const int taps : kTaps) {
    for (const float pixels_per_mm : kScales) {
      const double error = EdgeError(PixelKernel(HumanSkin(), taps, pixels_per_mm), pixels_per_mm);
      const double plain = EdgeError(MidpointKernel(taps, pixels_per_mm), pixels_per_mm);
      std::printf("%d taps, %.1f pixels per mm: RMSE %.5f, plain %.5f, staircase %.5f\n", taps,
                  static_cast<double>(pixels_per_mm), error, plain, StaircaseError(taps / 2));
      EXPECT_LE(error, plain + kTailLeftOut) << taps << " " << pixels_per_mm;
      EXPECT_LE(error, 0.75 * StaircaseError(taps / 2)) << taps << " " << pixels_per_mm;
    }
  }
}

// Both passes contribute to an edge that is not parallel to the picture's sides.
TEST(PixelKernel, EdgesInOtherDirectionsAreAsAccurate) {
  for (const int taps : kTaps) {
    for (const float pixels_per_mm : {3.0f, 5.0f, 8.0f, 16.0f}) {
      double sum = 0.0;
      double plain = 0.0;
      for (int degrees = 0; degrees < 90; degrees += 5) {
        const double turned = degrees * std::numbers::pi / 180.0;
        sum += Edge(PixelKernel(HumanSkin(), taps, pixels_per_mm), pixels_per_mm, turned)
                   .Rmse(50, 1.0 / pixels_per_mm);
        plain += Edge(MidpointKernel(taps, pixels_per_mm), pixels_per_mm, turned)
                     .Rmse(50, 1.0 / pixels_per_mm);
      }
      std::printf("%d taps, %.1f pixels per mm: mean RMSE %.5f, plain %.5f\n", taps,
                  static_cast<double>(pixels_per_mm), sum / 18, plain / 18);
      EXPECT_LE(sum, 1.02 * plain) << taps << " " << pixels_per_mm;
    }
  }
}

// Squared error of the staircase with steps starting at `starts`, up to `pixels`, weighted as in
// PixelKernel().
double StairsError(const std::vector<int>& starts, int pixels, double pixels_per_mm) {
  double error = 0.0;
  for (std::size_t i = 0; i < starts.size(); ++i) {
    const bool last = i + 1 == starts.size();
    const int end = last ? pixels : starts[i + 1];
    const auto light = [&](int k) {
      return glm::dvec3(StepResponse(HumanSkin(), (k + 0.5) / pixels_per_mm));
    };
    const auto counts = [&](int k) { return 1.0 + 2.0 * (k + 0.5) / pixels_per_mm; };
    glm::dvec3 level(0.0);
    double whole = 0.0;
    for (int k = starts[i]; k < end; ++k) {
      level += counts(k) * light(k);
      whole += counts(k);
    }
    level = last ? glm::dvec3(1.0) : level / whole;
    for (int k = starts[i]; k < end; ++k) {
      error += counts(k) * glm::dot(light(k) - level, light(k) - level);
    }
  }
  return error;
}

// Compared with all possible placements of five taps in twenty pixels.
TEST(PixelKernel, TapPlacementIsOptimal) {
  constexpr double kPixelsPerMm = 3.0;
  constexpr int kPixels = 24;
  const PixelTaps kernel = PixelKernel(HumanSkin(), 11, kPixelsPerMm);
  std::vector<int> places;
  for (const glm::vec2& offset : kernel.offsets) places.push_back(static_cast<int>(offset.x));
  ASSERT_EQ(places.size(), 6u);
  const double least = StairsError(places, kPixels, kPixelsPerMm);
  int better = 0;
  int tried = 0;
  for (unsigned mask = 0; mask < 1u << 20; ++mask) {
    if (__builtin_popcount(mask) != 5) continue;
    std::vector<int> others{0};
    for (int k = 0; k < 20; ++k) {
      if ((mask >> k & 1u) != 0) others.push_back(k + 1);
    }
    ++tried;
    if (StairsError(others, kPixels, kPixelsPerMm) < least - 1e-6) ++better;
  }
  EXPECT_EQ(tried, 15504);
  EXPECT_EQ(better, 0);
}

TEST(PixelGaussian, HasTheRequestedVariance) {
  EXPECT_EQ(PixelGaussian(0.2f).weights.size(), 1u);
  for (const float sigma : {0.4f, 0.7f, 1.0f, 1.5f, 3.0f, 11.0f}) {
    const PixelTaps kernel = PixelGaussian(sigma);
    const Moments moments = MomentsOf(kernel);
    EXPECT_NEAR(moments.sum.r, 1.0, 1e-5) << sigma;
    EXPECT_NEAR(moments.variance.r, sigma * sigma, 1e-3 * sigma * sigma) << sigma;
    for (const glm::vec3& weight : kernel.weights) EXPECT_GE(weight.r, 0.0f) << sigma;
    for (const glm::vec2& offset : kernel.offsets) EXPECT_EQ(offset.y, 0.0f) << sigma;
  }
}

}  // namespace
}  // namespace furrow::render

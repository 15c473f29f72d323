// SPDX-License-Identifier: Apache-2.0
// Expected values are worked out by hand from the formulas of fold_visibility.h and of the papers
// that it names, for gratings on a flat field.
#include "tests/observer/fold_visibility.h"

#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

namespace furrow::observer {
namespace {

constexpr int kFieldSize = 256;
constexpr int kRegion = 132;  // a square in the middle; 130 pixels without its rim
constexpr float kGrey = 0.5f;
constexpr double kBandWavelength = 13.07;  // pixels, of the band with sigma 2

Plane Fill(const std::function<double(int x, int y)>& function) {
  Plane plane{kFieldSize, kFieldSize, {}};
  for (int y = 0; y < kFieldSize; ++y) {
    for (int x = 0; x < kFieldSize; ++x) plane.values.push_back(static_cast<float>(function(x, y)));
  }
  return plane;
}

bool InSquare(int x, int y, int side) {
  return std::abs(2 * x + 1 - kFieldSize) < side && std::abs(2 * y + 1 - kFieldSize) < side;
}

FoldPictures OnGrey(const std::function<double(int x, int y)>& contrast) {
  return {.on = Fill([&](int x, int y) { return kGrey * (1.0 + contrast(x, y)); }),
          .off = Fill([](int, int) { return kGrey; }),
          .region = Fill([](int x, int y) { return InSquare(x, y, kRegion) ? 1.0 : 0.0; }),
          .subject = Fill([](int, int) { return 1.0; })};
}

double Sine(double x, double wavelength) {
  return std::sin(2.0 * std::numbers::pi * x / wavelength);
}

FoldPictures Grating(double contrast, double wavelength) {
  return OnGrey([=](int x, int) { return contrast * Sine(x, wavelength); });
}

FoldVisibility Measure(const FoldPictures& pictures, const Viewing& viewing = {}) {
  Result<FoldVisibility> found = MeasureFolds(pictures, viewing);
  EXPECT_TRUE(found.ok()) << found.status().ToString();
  return found.ok() ? *found : FoldVisibility();
}

TEST(ContrastSensitivity, IsThatOfMannosAndSakrison) {
  EXPECT_NEAR(ContrastSensitivity(8.0), 98.1, 0.1);  // the peak: a threshold of 1%
  EXPECT_NEAR(ContrastSensitivity(3.2), 71.8, 0.1);
  EXPECT_NEAR(ContrastSensitivity(1.8), 48.8, 0.3);
  EXPECT_NEAR(ContrastSensitivity(0.0), 5.0, 0.1);
  EXPECT_LT(ContrastSensitivity(60.0), 1.0);
  for (double f = 0.0; f < 40.0; f += 0.5) {
    EXPECT_LE(ContrastSensitivity(f), ContrastSensitivity(8.0) * 1.001) << f;
  }
}

TEST(ContrastThreshold, RisesWithTheBaseOnlyAboveItsOwnThreshold) {
  EXPECT_NEAR(ContrastThreshold(8.0, 0.0), 0.0102, 1e-4);
  EXPECT_DOUBLE_EQ(ContrastThreshold(8.0, 0.005), ContrastThreshold(8.0, 0.0));
  // 5% at 3.2 cycles per degree is 3.6 thresholds, and 3.6^0.7 = 2.45.
  EXPECT_NEAR(ContrastThreshold(3.2, 0.05) / ContrastThreshold(3.2, 0.0), 2.45, 0.01);
}

TEST(FoldBands, AreOctavesInsideTheRange) {
  const auto all = FoldBands({});
  ASSERT_EQ(all.size(), 3u);
  EXPECT_NEAR(all[0].wavelength_px, 6.54, 0.01);
  EXPECT_NEAR(all[1].wavelength_px, kBandWavelength, 0.01);
  EXPECT_NEAR(all[2].wavelength_px, 26.14, 0.01);
  EXPECT_NEAR(all[1].cycles_per_degree, 3.060, 0.001);
  // A body of 512 pixels, and half of that: the same two bands of 47 and 95 mm.
  const auto body =
      FoldBands({.millimetres_per_pixel = 3.62, .shortest_mm = 30, .longest_mm = 100});
  ASSERT_EQ(body.size(), 2u);
  EXPECT_DOUBLE_EQ(body[0].sigma, 2.0);
  const auto half =
      FoldBands({.millimetres_per_pixel = 7.24, .shortest_mm = 30, .longest_mm = 100});
  ASSERT_EQ(half.size(), 2u);
  EXPECT_DOUBLE_EQ(half[0].sigma, 1.0);
  EXPECT_TRUE(FoldBands({.millimetres_per_pixel = 50, .longest_mm = 100}).empty());
}

// The band's centre at the peak of the eye's sensitivity. Contrast 5% times 0.5 / 0.52 is 0.0481;
// 130 x 130 pixels are 98.9 square cycles, which pool as 2.468; S is 98.1. The formula gives
// 0.0481 * 2.468 * 98.1 = 11.6 JND. The finer band sees 0.552 of the contrast at S 69.1, the
// coarser band 0.332 at S 81.1: (11.63^4 + 6.39^4 + 2.26^4)^(1/4) / 1.2 = 9.9 JND.
TEST(MeasureFolds, ReadsAGratingAtThePeakAsTheFormulaDoes) {
  Viewing viewing;
  viewing.pixels_per_degree = 8.0 * kBandWavelength;
  const FoldVisibility found = Measure(Grating(0.05, kBandWavelength), viewing);
  EXPECT_EQ(found.pixels.size(), 130u * 130u);
  ASSERT_EQ(found.bands.size(), 3u);
  EXPECT_NEAR(found.bands[1].visibility, 11.6, 0.2);
  EXPECT_NEAR(found.visibility, 9.9, 0.2);
}

// At 40 pixels per degree, the band has 3.06 cycles per degree and S 69.9. The formula gives
// 0.0481 * 2.468 * 69.9 = 8.29 JND.
TEST(MeasureFolds, ReadsAGratingOfAFoldAsTheFormulaDoes) {
  const FoldVisibility found = Measure(Grating(0.05, kBandWavelength));
  EXPECT_NEAR(found.bands[1].visibility, 8.29, 0.15);
  EXPECT_NEAR(found.visibility, 8.29, 0.4);
  // A place pools 4 square cycles, (0.375 * 4)^(1/4) = 1.107, and not 98.9.
  const double place = found.places.at(kFieldSize / 2, kFieldSize / 2);
  EXPECT_NEAR(place, 8.29 * 1.107 / 2.468, 0.1);
}

TEST(MeasureFolds, ReadsTwiceTheContrastAsTwiceTheVisibility) {
  const double once = Measure(Grating(0.05, kBandWavelength)).visibility;
  EXPECT_NEAR(Measure(Grating(0.1, kBandWavelength)).visibility, 2.0 * once, 1e-3 * once);
}

TEST(MeasureFolds, DoesNotDependOnTheDirectionOfTheFolds) {
  const double across = Measure(Grating(0.05, kBandWavelength)).visibility;
  const auto diagonal = OnGrey([](int x, int y) {
    return 0.05 * Sine((x + y) * std::numbers::sqrt2 / 2.0, kBandWavelength);
  });
  EXPECT_NEAR(Measure(diagonal).visibility, across, 0.01 * across);
}

TEST(MeasureFolds, ReadsSixteenTimesTheAreaAsTwiceTheVisibility) {
  FoldPictures pictures = Grating(0.05, kBandWavelength);
  const double large = Measure(pictures).visibility;
  pictures.region = Fill([](int x, int y) { return InSquare(x, y, 35) ? 1.0 : 0.0; });
  EXPECT_NEAR(Measure(pictures).visibility, large / 2.0, 0.04 * large);
}

TEST(MeasureFolds, IsExactlyZeroWithoutADifference) {
  FoldPictures pictures = Grating(0.2, 9.0);
  pictures.off = pictures.on;
  const FoldVisibility found = Measure(pictures);
  EXPECT_EQ(found.visibility, 0.0);
  EXPECT_EQ(found.ShareAtLeast(1e-9), 0.0);
}

TEST(MeasureFolds, IsExactlyZeroInAPatchWithoutFolds) {
  // Folds only beyond the reach of the widest band around the region.
  const auto pictures = OnGrey([](int x, int y) {
    return InSquare(x, y, kRegion + 80) ? 0.0 : 0.2 * Sine(x, kBandWavelength);
  });
  EXPECT_EQ(Measure(pictures).visibility, 0.0);
}

TEST(MeasureFolds, IgnoresWavelengthsOutsideItsBands) {
  const double inside = Measure(Grating(0.1, kBandWavelength)).visibility;
  EXPECT_GT(inside, 15.0);
  EXPECT_LT(Measure(Grating(0.1, 2.1)).visibility, 1.0);  // weave
  // The slow rise of a limb's shading. Its 130 pixels are a fifth of a wavelength.
  EXPECT_LT(Measure(Grating(0.1, 640.0)).visibility, 0.5);
  // 13 mm is too short for folds of cloth, which have 30 to 100 mm.
  const Viewing cloth{.millimetres_per_pixel = 3.62, .shortest_mm = 30, .longest_mm = 100};
  EXPECT_LT(Measure(Grating(0.1, 13.0 / 3.62), cloth).visibility, 0.5);
}

TEST(MeasureFolds, TheBaseMasksFoldsOfItsOwnBand) {
  // 20% of base contrast at S 69.9: (14 * 0.5 / 0.52)^0.7 = 6.2 times the threshold in that band.
  FoldPictures pictures = Grating(0.05, kBandWavelength);
  const FoldVisibility plain = Measure(pictures);
  for (int i = 0; i < kFieldSize * kFieldSize; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const double base = kGrey * 0.2 * Sine(i / kFieldSize, kBandWavelength);
    pictures.on.values[at] += static_cast<float>(base);
    pictures.off.values[at] += static_cast<float>(base);
  }
  const FoldVisibility masked = Measure(pictures);
  EXPECT_NEAR(masked.bands[1].base_contrast, 0.2 * 0.5 / 0.52, 0.005);
  EXPECT_NEAR(plain.bands[1].visibility / masked.bands[1].visibility, 6.2, 0.2);
}

TEST(MeasureFolds, TheBackdropDoesNotChangeALimb) {
  // A limb 60 pixels wide with folds across it, before a black and before a white backdrop.
  const auto limb = [](double backdrop) {
    const auto inside = [](int x) { return std::abs(2 * x + 1 - kFieldSize) < 60; };
    return FoldPictures{
        .on = Fill([=](int x, int y) {
          return inside(x) ? kGrey * (1.0 + 0.05 * Sine(y, kBandWavelength)) : backdrop;
        }),
        .off = Fill([=](int x, int) { return inside(x) ? double{kGrey} : backdrop; }),
        .region = Fill([=](int x, int y) { return inside(x) && InSquare(x, y, 200) ? 1.0 : 0.0; }),
        .subject = Fill([=](int x, int) { return inside(x) ? 1.0 : 0.0; })};
  };
  const double black = Measure(limb(0.0)).visibility;
  EXPECT_GT(black, 5.0);
  EXPECT_DOUBLE_EQ(Measure(limb(1.0)).visibility, black);
}

TEST(MeasureFolds, TheShareIsThatOfTheFoldedPart) {
  // Folds in the left half of the region only.
  const auto half =
      OnGrey([](int x, int) { return x < kFieldSize / 2 ? 0.2 * Sine(x, kBandWavelength) : 0.0; });
  const FoldVisibility found = Measure(half);
  EXPECT_NEAR(found.ShareAtLeast(10.0), 0.5, 0.1);
  EXPECT_EQ(found.ShareAtLeast(1000.0), 0.0);
  EXPECT_EQ(found.ShareAtLeast(0.0), 1.0);
}

TEST(MeasureFolds, CropsWithoutAnEffect) {
  // The same scene in a picture whose edges are far from the region, and in the cut-out alone.
  FoldPictures pictures = Grating(0.05, kBandWavelength);
  pictures.region = Fill([](int x, int y) { return InSquare(x, y, 60) ? 1.0 : 0.0; });
  const double small = Measure(pictures).visibility;
  pictures.region.values[0] = 1.0f;  // a lone pixel: only rim, but it widens the bounds
  EXPECT_NEAR(Measure(pictures).visibility, small, 1e-6);
}

TEST(MeasureFolds, AnEmptyRegionHasNoFolds) {
  FoldPictures pictures = Grating(0.1, kBandWavelength);
  pictures.region = Fill([](int, int) { return 0.0; });
  EXPECT_EQ(Measure(pictures).visibility, 0.0);
  EXPECT_EQ(Measure(pictures).ShareAtLeast(0.0), 0.0);
}

TEST(MeasureFolds, RejectsInvalidPictures) {
  FoldPictures pictures = Grating(0.1, kBandWavelength);
  pictures.off.values.pop_back();
  EXPECT_EQ(MeasureFolds(pictures, {}).status().code(), StatusCode::kInvalidArgument);
  pictures = Grating(0.1, kBandWavelength);
  pictures.subject = {8, 8, std::vector<float>(64)};
  EXPECT_EQ(MeasureFolds(pictures, {}).status().code(), StatusCode::kInvalidArgument);
  pictures = Grating(0.1, kBandWavelength);
  pictures.on.values[5] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(MeasureFolds(pictures, {}).status().code(), StatusCode::kNonFinite);
  pictures = Grating(0.1, kBandWavelength);
  EXPECT_EQ(MeasureFolds(pictures, {.millimetres_per_pixel = 50, .longest_mm = 1}).status().code(),
            StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace furrow::observer

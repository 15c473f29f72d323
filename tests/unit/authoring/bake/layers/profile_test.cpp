// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/layers/profile.h"

#include <cmath>

#include <gtest/gtest.h>

namespace furrow::authoring {
namespace {

constexpr double kTurn = 6.283185307179586;

FoldProfile::Sample At(const FoldProfile& profile, double phase) {
  return profile.At(static_cast<float>(std::cos(phase)), static_cast<float>(std::sin(phase)));
}

TEST(FoldProfile, HasAValleyAtPhaseZeroMeanZeroAndHeightTwo) {
  for (const float sharpness : {0.0f, 0.3f, 0.7f, 1.0f}) {
    const FoldProfile profile(sharpness);
    double sum = 0.0;
    float low = 10.0f, high = -10.0f;
    for (int i = 0; i < 1000; ++i) {
      const float height = At(profile, kTurn * i / 1000).height;
      sum += height;
      low = std::min(low, height);
      high = std::max(high, height);
    }
    EXPECT_NEAR(sum / 1000, 0.0, 1e-3) << sharpness;
    EXPECT_NEAR(high - low, 2.0f, 1e-4f) << sharpness;
    EXPECT_EQ(At(profile, 0.0).height, low) << sharpness;
    EXPECT_NEAR(At(profile, 1.1).height, At(profile, -1.1).height, 1e-6f) << sharpness;
  }
}

TEST(FoldProfile, SlopeIsTheDerivativeOfTheHeight) {
  const FoldProfile profile(0.7f);
  for (double phase = 0.05; phase < kTurn; phase += 0.37) {
    const double numeric =
        (At(profile, phase + 1e-3).height - At(profile, phase - 1e-3).height) / 2e-3;
    EXPECT_NEAR(At(profile, phase).slope, numeric, 5e-3) << phase;
  }
}

TEST(FoldProfile, SharpValleysAreNarrowerThanTheirRidges) {
  const auto below = [](float sharpness) {
    const FoldProfile profile(sharpness);
    int count = 0;
    for (int i = 0; i < 1000; ++i) count += At(profile, kTurn * i / 1000).height < 0.0f ? 1 : 0;
    return count / 1000.0;
  };
  EXPECT_NEAR(below(0.0f), 0.5, 0.04);  // a sine
  EXPECT_LT(below(0.9f), 0.35);
  EXPECT_LT(below(0.9f), below(0.5f));
}

TEST(FoldProfile, BluntFoldHasTheAmplitudeOfASine) {
  // For small e: A = (lambda / pi) sqrt(e), which is 2 sqrt(e) in units of lambda / (2 pi).
  const FoldProfile profile(0.0f);
  for (const float e : {0.005f, 0.01f, 0.02f}) {
    EXPECT_NEAR(profile.Amplitude(e), 2.0f * std::sqrt(e), 0.04f * 2.0f * std::sqrt(e)) << e;
  }
  EXPECT_EQ(profile.Amplitude(0.0f), 0.0f);
}

TEST(FoldProfile, AmplitudeKeepsTheArcLength) {
  for (const float sharpness : {0.0f, 0.7f}) {
    const FoldProfile profile(sharpness);
    for (const float e : {0.001f, 0.03f, 0.2f, 0.5f, 0.9f}) {
      const double a = profile.Amplitude(e);
      double arc = 0.0;
      for (int i = 0; i < 4000; ++i) {
        const double rise = a * At(profile, kTurn * (i + 0.5) / 4000).slope;
        arc += std::hypot(1.0 - e, rise);
      }
      EXPECT_NEAR(arc / 4000, 1.0, 0.003) << sharpness << " " << e;
    }
  }
}

}  // namespace
}  // namespace furrow::authoring

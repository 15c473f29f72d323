// SPDX-License-Identifier: Apache-2.0
#include "gltf/animation/track.h"

#include <cmath>

#include <gtest/gtest.h>

namespace furrow::gltf {
namespace {

using Interpolation = Track::Interpolation;

Track Make(Interpolation interpolation, std::vector<float> times, std::vector<float> values,
           std::size_t width = 1) {
  Track track;
  track.interpolation = interpolation;
  track.width = width;
  track.is_rotation = width == 4;
  track.times = std::make_shared<const std::vector<float>>(std::move(times));
  track.values = std::move(values);
  return track;
}

float At(const Track& track, double time) {
  float value = NAN;
  track.Evaluate(time, &value);
  return value;
}

TEST(Track, HoldsTheEndsAndStepsOrInterpolates) {
  const Track linear = Make(Interpolation::kLinear, {1, 2, 4}, {10, 20, 0});
  EXPECT_FLOAT_EQ(At(linear, 0.0), 10.0f);
  EXPECT_FLOAT_EQ(At(linear, 1.5), 15.0f);
  EXPECT_FLOAT_EQ(At(linear, 2.0), 20.0f);
  EXPECT_FLOAT_EQ(At(linear, 3.5), 5.0f);
  EXPECT_FLOAT_EQ(At(linear, 9.0), 0.0f);
  const Track step = Make(Interpolation::kStep, {1, 2, 4}, {10, 20, 0});
  EXPECT_FLOAT_EQ(At(step, 0.0), 10.0f);
  EXPECT_FLOAT_EQ(At(step, 1.999), 10.0f);
  EXPECT_FLOAT_EQ(At(step, 2.0), 20.0f);
  EXPECT_FLOAT_EQ(At(step, 4.0), 0.0f);
}

// A cubic Hermite spline reproduces every cubic:
// f(t) = t^3 - 2 t on keys 0, 1, 3 with its derivatives.
TEST(Track, CubicSplineReproducesACubic) {
  const auto f = [](float t) { return t * t * t - 2.0f * t; };
  const auto d = [](float t) { return 3.0f * t * t - 2.0f; };
  std::vector<float> values;
  for (const float t : {0.0f, 1.0f, 3.0f}) values.insert(values.end(), {d(t), f(t), d(t)});
  const Track track = Make(Interpolation::kCubicSpline, {0, 1, 3}, values);
  for (int i = 0; i <= 30; ++i) {
    const float t = 0.1f * static_cast<float>(i);
    EXPECT_NEAR(At(track, static_cast<double>(t)), f(t), 1e-4f) << t;
  }
}

TEST(Track, SlerpFollowsTheShorterArcAtConstantSpeed) {
  // From 0 to 120 degrees about X. The second quaternion has the opposite sign.
  const float s = std::sin(M_PI / 3.0), c = std::cos(M_PI / 3.0);
  const Track track = Make(Interpolation::kLinear, {0, 1}, {0, 0, 0, 1, -s, 0, 0, -c}, 4);
  float q[4];
  for (int i = 0; i <= 4; ++i) {
    track.Evaluate(0.25 * i, q);
    const float expected = static_cast<float>(M_PI / 12.0 * i);  // half of 30 degrees per step
    EXPECT_NEAR(std::abs(q[0]), std::sin(expected), 1e-5f);
    EXPECT_NEAR(std::abs(q[3]), std::cos(expected), 1e-5f);
  }
}

TEST(Track, SplinedRotationsAreUnit) {
  const Track track =
      Make(Interpolation::kCubicSpline, {0, 1}, {0, 0, 0, 0, 0, 0, 0, 1, 5, 0, 0, 0,  //
                                                 0, 3, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0},
           4);
  float q[4];
  for (int i = 0; i <= 20; ++i) {
    track.Evaluate(i / 20.0, q);
    EXPECT_NEAR(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3], 1.0f, 1e-5f);
  }
}

}  // namespace
}  // namespace furrow::gltf

// SPDX-License-Identifier: Apache-2.0
#include "render/skin/beckmann.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace furrow::render {
namespace {

// The albedo by plain quadrature over light directions, independent of SpecularAlbedo()'s half
// vectors.
double BruteForceAlbedo(double cos_view, double m, double f0, SpecularNorm norm) {
  constexpr int kCosines = 2000;
  constexpr int kAzimuths = 1000;
  const double sin_view = std::sqrt(1.0 - cos_view * cos_view);
  double sum = 0.0;
  for (int i = 0; i < kCosines; ++i) {
    const double cos_light = (i + 0.5) / kCosines;
    const double sin_light = std::sqrt(1.0 - cos_light * cos_light);
    for (int j = 0; j < kAzimuths; ++j) {
      const double azimuth = std::numbers::pi * (j + 0.5) / kAzimuths;
      const double between = cos_light * cos_view + sin_light * sin_view * std::cos(azimuth);
      sum += KelemenBrdf(cos_light, cos_view, between, m, f0, norm) * cos_light;
    }
  }
  return sum * 2.0 * std::numbers::pi / (kCosines * kAzimuths);
}

double Albedo(double cos, double m, double f0) {
  const glm::dvec2 albedo = SpecularAlbedo(cos, m);
  return f0 * albedo.x + (1.0 - f0) * albedo.y;
}

TEST(Beckmann, DistributionIsNormalised) {
  for (const double m : {0.1, 0.3, 0.6}) {
    double sum = 0.0;
    constexpr int kSteps = 20000;
    for (int i = 0; i < kSteps; ++i) {
      const double cos_h = (i + 0.5) / kSteps;
      sum += BeckmannPh(cos_h, m) * cos_h * 2.0 * std::numbers::pi / kSteps;
    }
    EXPECT_NEAR(sum, std::numbers::pi, 1e-3) << m;  // PH does not include the 1/pi
  }
}

TEST(Beckmann, IsFiniteAtTheEndsOfItsRange) {
  EXPECT_EQ(BeckmannPh(0.0, 0.3), 0.0);
  EXPECT_EQ(BeckmannPh(-0.5, 0.3), 0.0);
  EXPECT_NEAR(BeckmannPh(1.0, 0.3), 1.0 / 0.09, 1e-9);
  EXPECT_NEAR(BeckmannPh(1.0, 0.0), 1024.0, 1e-6);  // m is clamped to 1/32
  EXPECT_EQ(KelemenBrdf(0.0, 1.0, 0.0, 0.3, 0.028, SpecularNorm::kPhysical), 0.0);
  EXPECT_EQ(KelemenBrdf(1e-9, 1e-9, -1.0, 0.3, 0.028, SpecularNorm::kPhysical), 0.0);
}

TEST(Beckmann, BrdfIsReciprocal) {
  const auto brdf = [](double l, double v) {
    return KelemenBrdf(l, v, 0.2, 0.3, 0.028, SpecularNorm::kPhysical);
  };
  EXPECT_DOUBLE_EQ(brdf(0.3, 0.9), brdf(0.9, 0.3));
  // At normal incidence: PH(1) F0 / 4 / pi.
  const double face_on = KelemenBrdf(1.0, 1.0, 1.0, 0.3, 0.028, SpecularNorm::kPhysical);
  EXPECT_NEAR(face_on, 0.028 / 0.09 / 4.0 / std::numbers::pi, 1e-9);
  const double gems = KelemenBrdf(1.0, 1.0, 1.0, 0.3, 0.028, SpecularNorm::kGems);
  EXPECT_NEAR(gems / face_on, std::numbers::pi, 1e-9);
}

// The published form reflects more light than it receives at grazing angles.
TEST(Beckmann, GemsExceedsOneWherePhysicalDoesNot) {
  EXPECT_NEAR(BruteForceAlbedo(0.1, 0.1, 0.028, SpecularNorm::kGems), 1.25, 0.01);
  EXPECT_NEAR(BruteForceAlbedo(0.1, 0.1, 0.028, SpecularNorm::kPhysical), 0.40, 0.005);
}

TEST(Beckmann, AlbedoMatchesPlainQuadrature) {
  for (const double m : {0.15, 0.3, 0.6}) {
    for (const double cos : {0.15, 0.5, 1.0}) {
      const double plain = BruteForceAlbedo(cos, m, 0.028, SpecularNorm::kPhysical);
      EXPECT_NEAR(Albedo(cos, m, 0.028), plain, 0.01 * plain) << m << " " << cos;
    }
  }
}

TEST(Beckmann, PhysicalAlbedoIsAtMostOneEverywhere) {
  for (const double f0 : {0.02, 0.028, 0.2, 1.0}) {
    for (double m = 0.0; m <= 1.0; m += 1.0 / 24) {
      for (double cos = 0.0; cos <= 1.0; cos += 1.0 / 24) {
        const double albedo = Albedo(cos, m, f0);
        EXPECT_LE(albedo, 1.0) << "F0 " << f0 << " m " << m << " cos " << cos;
        EXPECT_GE(albedo, 0.0);
      }
    }
  }
}

// Looks up the table as a shader does: bilinear, with the mapping that the header states.
double LookUp(const std::vector<std::uint16_t>& table, int size, double x, double y) {
  const auto at = [&](int column, int row) {
    return table[static_cast<std::size_t>(row * size + column)] / 65535.0;
  };
  const double u = x * (size - 1);
  const double v = y * (size - 1);
  const int column = std::min(static_cast<int>(u), size - 2);
  const int row = std::min(static_cast<int>(v), size - 2);
  const double fu = u - column;
  const double fv = v - row;
  const double t = (1 - fv) * ((1 - fu) * at(column, row) + fu * at(column + 1, row)) +
                   fv * ((1 - fu) * at(column, row + 1) + fu * at(column + 1, row + 1));
  return std::pow(2.0 * t, 10.0);
}

// Applies wherever the highlight is brighter than a millionth of its peak.
TEST(Beckmann, TableIsWithinOnePercent) {
  constexpr int kSize = 512;
  const std::vector<std::uint16_t> table = BeckmannTable(kSize);
  double worst = 0.0;
  for (double m = 0.15; m <= 0.6; m += 0.0137) {
    const double peak = BeckmannPh(1.0, m);
    for (double cos_h = 0.0; cos_h <= 1.0; cos_h += 0.00037) {
      const double exact = BeckmannPh(cos_h, m);
      const double looked_up = LookUp(table, kSize, cos_h, m);
      if (exact < 1e-6 * peak) {
        EXPECT_LT(looked_up, 2e-6 * peak);
        continue;
      }
      worst = std::max(worst, std::abs(looked_up / exact - 1.0));
    }
  }
  printf("Beckmann table, %d x %d, R16: worst relative error %.5f\n", kSize, kSize, worst);
  EXPECT_LT(worst, 0.01);
}

TEST(Beckmann, TablesHaveTheirEndsOnTexelCentres) {
  const std::vector<std::uint16_t> table = BeckmannTable(64);
  EXPECT_EQ(table.front(), 0);
  EXPECT_EQ(table[63], 65535);     // m = 0 is clamped to 1/32: 0.5 * 1024^0.1 = 1
  EXPECT_EQ(table.back(), 32768);  // m = 1: 0.5
  const std::vector<glm::vec2> albedo = SpecularAlbedoTable(4);
  EXPECT_EQ(albedo[4 * 1 + 2], glm::vec2(SpecularAlbedo(2.0 / 3.0, 1.0 / 3.0)));
}

TEST(Beckmann, TwoLobesMatchTheTableOfOne) {
  constexpr int kSize = 65;  // half of every second row is a row
  const std::vector<glm::vec2> one = SpecularAlbedoTable(kSize);
  const std::vector<glm::vec4> both = TwoLobeAlbedoTable(kSize);
  ASSERT_EQ(both.size(), one.size());
  for (const int row : {0, 2, 4, 30, 64}) {
    const int half = std::max(row / 2, 2);  // 1/32
    for (const int column : {0, 20, 64}) {
      const glm::vec4 texel = both[static_cast<std::size_t>(row * kSize + column)];
      const glm::vec2 first = one[static_cast<std::size_t>(row * kSize + column)];
      const glm::vec2 second = one[static_cast<std::size_t>(half * kSize + column)];
      EXPECT_EQ(texel, glm::vec4(first, second)) << row << ' ' << column;
    }
  }
}

}  // namespace
}  // namespace furrow::render

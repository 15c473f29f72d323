// SPDX-License-Identifier: Apache-2.0
#include "render/skin/beckmann.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>

namespace furrow::render {
namespace {

double ClampM(double m) { return std::max(m, static_cast<double>(kMinBeckmannM)); }

double Pow5(double x) { return x * x * x * x * x; }

// Calls `set(x, m)` for every texel of a table, row by row.
template <class Set>
void ForEachTexel(int size, const Set& set) {
  for (int row = 0; row < size; ++row) {
    for (int column = 0; column < size; ++column) {
      set(static_cast<double>(column) / (size - 1), static_cast<double>(row) / (size - 1));
    }
  }
}

}  // namespace

double BeckmannPh(double cos_h, double m) {
  if (cos_h <= 0.0) return 0.0;  // avoids 0/0; the limit is 0
  const double safe_m = ClampM(m);
  const double cos2 = cos_h * cos_h;
  const double tan2 = (1.0 - std::min(cos2, 1.0)) / cos2;
  const double m2 = safe_m * safe_m;
  const double exponent = -tan2 / m2;
  return exponent < -700.0 ? 0.0 : std::exp(exponent) / (m2 * cos2 * cos2);
}

double SchlickFresnel(double f0, double cos) {
  return f0 + (1.0 - f0) * Pow5(1.0 - std::clamp(cos, 0.0, 1.0));
}

double KelemenBrdf(double cos_light, double cos_view, double cos_between, double m, double f0,
                   SpecularNorm norm) {
  if (cos_light <= 0.0 || cos_view <= 0.0) return 0.0;
  const double length2 = 2.0 + 2.0 * cos_between;  // of h = L + V
  if (length2 < 1e-9) return 0.0;
  const double length = std::sqrt(length2);
  const double cos_h = (cos_light + cos_view) / length;
  const double ph = BeckmannPh(std::min(cos_h, 1.0), m);
  const double f = ph * SchlickFresnel(f0, 0.5 * length) / length2;  // H.V = |L + V| / 2
  return norm == SpecularNorm::kPhysical ? f / std::numbers::pi : f;
}

std::vector<std::uint16_t> BeckmannTable(int size) {
  std::vector<std::uint16_t> table;
  table.reserve(static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
  ForEachTexel(size, [&](double cos_h, double m) {
    const double t = std::min(0.5 * std::pow(BeckmannPh(cos_h, m), 0.1), 1.0);
    table.push_back(static_cast<std::uint16_t>(std::lround(t * 65535.0)));
  });
  return table;
}

glm::dvec2 SpecularAlbedo(double cos, double m) {
  // Half vectors by importance sampling: u of exp(-tan^2 / m^2) and the azimuth, on a grid of
  // midpoints. The density PH cos_h / pi cancels the distribution, and dL = 4 (V.H) dH. Each sample
  // is therefore F cos_l / ((V.H) cos_h), which stays at or below 2 even at grazing angles.
  constexpr int kRadii = 32;
  constexpr int kAzimuths = 32;
  const double safe_m = ClampM(m);
  const double cos_v = std::clamp(cos, 1e-4, 1.0);
  const double sin_v = std::sqrt(1.0 - cos_v * cos_v);
  glm::dvec2 sum(0.0);
  for (int i = 0; i < kRadii; ++i) {
    const double tan2 = -safe_m * safe_m * std::log(1.0 - (i + 0.5) / kRadii);
    const double cos_h = 1.0 / std::sqrt(1.0 + tan2);
    const double sin_h = std::sqrt(tan2) * cos_h;
    for (int j = 0; j < kAzimuths; ++j) {
      const double azimuth =
          std::numbers::pi * (j + 0.5) / kAzimuths;  // the other half is its mirror image
      const double cos_vh = cos_v * cos_h + sin_v * sin_h * std::cos(azimuth);
      if (cos_vh <= 0.0) continue;
      const double cos_l = 2.0 * cos_vh * cos_h - cos_v;
      if (cos_l <= 0.0) continue;
      const double grazing = Pow5(1.0 - cos_vh);
      sum += glm::dvec2(1.0, grazing) * (cos_l / (cos_vh * cos_h));
    }
  }
  return sum / static_cast<double>(kRadii * kAzimuths);
}

std::vector<glm::vec2> SpecularAlbedoTable(int size) {
  std::vector<glm::vec2> table;
  table.reserve(static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
  ForEachTexel(size, [&](double cos, double m) { table.push_back(SpecularAlbedo(cos, m)); });
  return table;
}

std::vector<glm::vec4> TwoLobeAlbedoTable(int size) {
  const std::vector<glm::vec2> one = SpecularAlbedoTable(size);
  std::vector<glm::vec4> both;
  both.reserve(one.size());
  // In rows. The shader looks up m / 2 in the same row as m, so the second lobe is resampled to
  // rows of m.
  const float least = static_cast<float>(kMinBeckmannM) * static_cast<float>(size - 1);
  for (int row = 0; row < size; ++row) {
    const float half = std::max(0.5f * static_cast<float>(row), least);
    const int below = std::min(static_cast<int>(half), size - 2);
    for (int column = 0; column < size; ++column) {
      const auto at = [&](int r) { return one[static_cast<std::size_t>(r * size + column)]; };
      both.emplace_back(at(row),
                        glm::mix(at(below), at(below + 1), half - static_cast<float>(below)));
    }
  }
  return both;
}

}  // namespace furrow::render

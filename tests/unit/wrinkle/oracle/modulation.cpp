// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/wrinkle/oracle/modulation.h"

#include <cmath>

#include "base/scalar.h"

namespace furrow::wrinkle {

float CosineModulation(float x) { return 0.5f * (1.0f - std::cos(kPi * x)); }

float CubicModulation(float x) { return x * (2.62235f + x * (-4.87773f + x * 3.26168f)); }

namespace {

double Rise(std::span<const CurvePoint> p, std::size_t i) {
  return (double{p[i + 1].y} - double{p[i].y}) / (double{p[i + 1].x} - double{p[i].x});
}

double Width(std::span<const CurvePoint> p, std::size_t i) {
  return double{p[i + 1].x} - double{p[i].x};
}

// SciPy's rule for the ends.
double SlopeAtEnd(double h0, double h1, double m0, double m1) {
  const double slope = ((2.0 * h0 + h1) * m0 - h0 * m1) / (h0 + h1);
  if (std::copysign(1.0, slope) != std::copysign(1.0, m0) || m0 == 0.0) return 0.0;
  if (std::copysign(1.0, m0) != std::copysign(1.0, m1) && std::abs(slope) > std::abs(3.0 * m0)) {
    return 3.0 * m0;
  }
  return slope;
}

double SlopeOf(std::span<const CurvePoint> p, std::size_t i) {
  const std::size_t last = p.size() - 1;
  if (last == 1) return Rise(p, 0);
  if (i == 0) return SlopeAtEnd(Width(p, 0), Width(p, 1), Rise(p, 0), Rise(p, 1));
  if (i == last) {
    return SlopeAtEnd(Width(p, last - 1), Width(p, last - 2), Rise(p, last - 1), Rise(p, last - 2));
  }
  const double before = Rise(p, i - 1);
  const double after = Rise(p, i);
  if (!(before * after > 0.0)) return 0.0;
  const double alpha = (1.0 + Width(p, i) / (Width(p, i - 1) + Width(p, i))) / 3.0;
  return before * after / (alpha * after + (1.0 - alpha) * before);
}

}  // namespace

double CurveModulation(std::span<const CurvePoint> p, double x) {
  if (x <= double{p.front().x}) return double{p.front().y};
  if (x >= double{p.back().x}) return double{p.back().y};
  std::size_t i = 0;
  while (x >= double{p[i + 1].x}) ++i;
  const double h = Width(p, i);
  const double s = (x - double{p[i].x}) / h;
  return (1.0 + 2.0 * s) * (1.0 - s) * (1.0 - s) * double{p[i].y} +
         s * (1.0 - s) * (1.0 - s) * h * SlopeOf(p, i) +
         s * s * (3.0 - 2.0 * s) * double{p[i + 1].y} + s * s * (s - 1.0) * h * SlopeOf(p, i + 1);
}

float Modulate(const FeedModulation& modulation, float x) {
  const float clamped = Saturate(x);
  if (!modulation.curve.empty()) {
    return Saturate(static_cast<float>(CurveModulation(modulation.curve, double{clamped})));
  }
  switch (modulation.modulation) {
    case Modulation::kLinear: return clamped;
    case Modulation::kCosine: return Saturate(CosineModulation(clamped));
    case Modulation::kCubic: return Saturate(CubicModulation(clamped));
  }
  return clamped;
}

}  // namespace furrow::wrinkle

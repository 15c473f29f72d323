// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/wrinkle/oracle/modulation.h"

#include <cmath>

#include "base/scalar.h"

namespace furrow::wrinkle {

float CosineModulation(float x) { return 0.5f * (1.0f - std::cos(kPi * x)); }

float CubicModulation(float x) { return x * (2.62235f + x * (-4.87773f + x * 3.26168f)); }

float Modulate(Modulation modulation, float x) {
  const float clamped = Saturate(x);
  switch (modulation) {
    case Modulation::kLinear: return clamped;
    case Modulation::kCosine: return Saturate(CosineModulation(clamped));
    case Modulation::kCubic: return Saturate(CubicModulation(clamped));
  }
  return clamped;
}

}  // namespace furrow::wrinkle

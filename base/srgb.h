// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace furrow {

// The transfer function of sRGB (IEC 61966-2-1). Both values are in [0, 1].
[[nodiscard]] inline float LinearFromSrgb(float value) {
  return value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f);
}
[[nodiscard]] inline float SrgbFromLinear(float value) {
  return value <= 0.0031308f ? 12.92f * value : 1.055f * std::pow(value, 1.0f / 2.4f) - 0.055f;
}

}  // namespace furrow

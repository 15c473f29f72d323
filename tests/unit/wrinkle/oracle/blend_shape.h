// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/scalar.h"

namespace furrow::wrinkle {

// A tracker's coefficient as a driver value. `full` may be below `neutral`, but not equal.
[[nodiscard]] inline float BlendShapeValue(float coefficient, float neutral, float full) {
  return Saturate((coefficient - neutral) / (full - neutral));
}

}  // namespace furrow::wrinkle

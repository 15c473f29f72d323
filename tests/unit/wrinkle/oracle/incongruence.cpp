// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/wrinkle/oracle/incongruence.h"

#include "base/scalar.h"

namespace furrow::wrinkle {

float CongruenceFactor(float own, float other) {
  const float sum = own + other;
  if (!(sum > 0.0f)) return 1.0f;
  return Smoothstep(-0.5f, 0.5f, (own - other) / sum);
}

}  // namespace furrow::wrinkle

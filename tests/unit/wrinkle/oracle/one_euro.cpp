// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/wrinkle/oracle/one_euro.h"

#include <cmath>

#include "base/scalar.h"

namespace furrow::wrinkle {

double LowPassShare(double cutoff_hz, double dt) {
  if (dt <= 0.0) return 0.0;
  const double tau = 1.0 / (2.0 * double{kPi} * cutoff_hz);
  return 1.0 / (1.0 + tau / dt);
}

double OneEuro::Step(double previous, double input, double raw_slope, double dt,
                     double* speed) const {
  *speed += LowPassShare(derivative_cutoff_hz, dt) * (raw_slope - *speed);
  const double cutoff = min_cutoff_hz + beta * std::abs(*speed);
  return previous + LowPassShare(cutoff, dt) * (input - previous);
}

}  // namespace furrow::wrinkle

// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/wrinkle/oracle/one_euro.h"

#include <cmath>

#include "base/scalar.h"

namespace furrow::wrinkle {
namespace {

constexpr double kTwoPi = 2.0 * double{kPi};

}  // namespace

double LowPassShare(double cutoff_hz, double dt) { return -std::expm1(-kTwoPi * cutoff_hz * dt); }

double OneEuro::Step(double previous, double input, double raw_slope, double dt,
                     double* speed) const {
  // speed' = a (slope - speed): an exponential, and its mean over the step.
  const double share = LowPassShare(derivative_cutoff_hz, dt);
  const double mean_left = share / (kTwoPi * derivative_cutoff_hz * dt);
  const double mean = raw_slope + mean_left * (*speed - raw_slope);
  *speed += share * (raw_slope - *speed);
  // y' = a (x - y) for x on a line: y runs behind the line by slope / a once it has settled.
  const double cutoff = min_cutoff_hz + beta * std::abs(mean);
  const double behind = raw_slope / (kTwoPi * cutoff);
  const double line = input - raw_slope * dt;
  return input - behind + (1.0 - LowPassShare(cutoff, dt)) * (previous - line + behind);
}

}  // namespace furrow::wrinkle

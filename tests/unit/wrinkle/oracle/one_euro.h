// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace furrow::wrinkle {

// Share of a constant input that a first-order low-pass of `cutoff_hz` takes over after `dt`
// seconds: 1 - exp(-2 pi cutoff dt). 0 at dt = 0, towards 1 for a long dt.
[[nodiscard]] double LowPassShare(double cutoff_hz, double dt);

// One step of the One-Euro filter: a low-pass with a cut-off that rises with the signal's speed, so
// that rest is steady and motion has little lag. The input runs in a straight line of slope
// `raw_slope` to `input`, and both low-passes follow it exactly.
//
// - `speed` is the low-passed derivative, 1/s, updated in place; `raw_slope` the derivative of the
//   raw signal over the last step. `dt` > 0.
// - The cut-off follows from the mean of `speed` over the step.
// - Source: Casiez, Roussel and Vogel, 1 Euro Filter (CHI 2012), in continuous time.
struct OneEuro {
  double min_cutoff_hz = 4.0;
  double beta = 1.0;
  double derivative_cutoff_hz = 1.0;

  [[nodiscard]] double Step(double previous, double input, double raw_slope, double dt,
                            double* speed) const;
};

}  // namespace furrow::wrinkle

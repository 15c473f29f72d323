// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/wrinkle/oracle/filter_oracle.h"

#include <algorithm>
#include <cmath>

#include "base/scalar.h"
#include "tests/unit/wrinkle/oracle/one_euro.h"

namespace furrow::wrinkle {

FilterOracle::FilterOracle(const Filter& filter, std::size_t num_values)
    : filter_(filter), values_(num_values), inputs_(num_values), speeds_(num_values) {}

double FilterOracle::LimitSlew(double previous, double wanted, double dt) const {
  if (filter_.slew_per_second <= 0.0f) return wanted;
  const double most = double{filter_.slew_per_second} * dt;
  return previous + std::clamp(wanted - previous, -most, most);
}

void FilterOracle::Update(std::span<const float> inputs, double dt) {
  if (!started_ || !filter_.enabled) {
    values_.assign(inputs.begin(), inputs.end());
    inputs_ = values_;
    std::ranges::fill(speeds_, 0.0f);
    since_input_ = 0.0;
    started_ = true;
    return;
  }
  if (dt < 1e-6) return;  // inputs at the same time
  const OneEuro one_euro{.min_cutoff_hz = filter_.min_cutoff_hz,
                         .beta = filter_.beta,
                         .derivative_cutoff_hz = filter_.derivative_cutoff_hz};
  for (std::size_t i = 0; i < values_.size(); ++i) {
    const double slope = (double{inputs[i]} - double{inputs_[i]}) / (since_input_ + dt);
    double speed = speeds_[i];
    const double smooth = one_euro.Step(values_[i], inputs[i], slope, dt, &speed);
    values_[i] = Saturate(static_cast<float>(LimitSlew(values_[i], smooth, dt)));
    speeds_[i] = static_cast<float>(speed);
    inputs_[i] = inputs[i];
  }
  since_input_ = 0.0;
}

void FilterOracle::Decay(double dt) {
  if (!started_) return;
  since_input_ += dt;
  const double decaying = std::min(dt, since_input_ - double{filter_.hold_seconds});
  if (decaying <= 0.0) return;
  const double share =
      filter_.decay_seconds > 0.0f ? std::exp(-decaying / double{filter_.decay_seconds}) : 0.0;
  for (std::size_t i = 0; i < values_.size(); ++i) {
    const double next = LimitSlew(values_[i], values_[i] * share, dt);
    values_[i] = next < 1e-5 ? 0.0f : static_cast<float>(next);
    speeds_[i] = 0.0f;
  }
}

}  // namespace furrow::wrinkle

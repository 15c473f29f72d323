// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/weights/filter.h"

#include <algorithm>
#include <cmath>

namespace furrow::wrinkle {
namespace {

constexpr double kLeastStep = 1e-6;  // seconds; closer inputs count as simultaneous
constexpr float kNeutral = 1e-5f;    // a decaying value below this becomes 0

// Moves from `previous` towards `wanted` by at most the slew limit. A limit of 0 means none.
float LimitFall(float previous, float wanted, float slew_per_second, double dt) {
  if (slew_per_second <= 0.0f) return wanted;
  const double most = double{slew_per_second} * dt;
  const double change = std::clamp(double{wanted} - double{previous}, -most, most);
  return static_cast<float>(double{previous} + change);
}

}  // namespace

void FilterContext::Resize(std::size_t num_values) {
  value.assign(num_values, 0.0f);
  raw.assign(num_values, 0.0f);
  derivative.assign(num_values, 0.0f);
  since_input = 0.0;
  started = false;
}

void FilterContext::Reset() { Resize(value.size()); }

FilterMove MoveOn(const Filter& filter, const FilterContext& context, double dt) {
  if (!context.started || !filter.enabled) return FilterMove::kStart;
  return dt >= kLeastStep ? FilterMove::kFollow : FilterMove::kStay;
}

void HoldAndDecay(const Filter& filter, double dt, FilterContext* context) {
  if (!context->started) return;
  context->since_input += dt;
  // The step may begin within the hold. Only the rest of it decays.
  const double decaying = std::min(dt, context->since_input - double{filter.hold_seconds});
  if (decaying <= 0.0) return;
  const double share =
      filter.decay_seconds > 0.0f ? std::exp(-decaying / double{filter.decay_seconds}) : 0.0;
  for (std::size_t i = 0; i < context->value.size(); ++i) {
    const float target = static_cast<float>(context->value[i] * share);
    const float next = LimitFall(context->value[i], target, filter.slew_per_second, dt);
    // An exponential never reaches 0 by itself.
    context->value[i] = next < kNeutral ? 0.0f : next;
    context->derivative[i] = 0.0f;
  }
}

}  // namespace furrow::wrinkle

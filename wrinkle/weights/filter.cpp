// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "base/scalar.h"
#include "wrinkle/skeleton/finite.h"
#include "wrinkle/solver/solver.h"
#include "wrinkle/weights/filter_move.h"
#include "wrinkle/weights/one_euro.h"

namespace furrow::wrinkle {
namespace {

constexpr float kNeutral = 1e-5f;  // a decaying value below this has arrived

float LimitSlew(float previous, float wanted, float slew_per_second, double dt) {
  if (slew_per_second <= 0.0f) return wanted;
  const double most = double{slew_per_second} * dt;
  const double change = std::clamp(double{wanted} - double{previous}, -most, most);
  return static_cast<float>(double{previous} + change);
}

void Start(const FilterJob& job) {
  FilterContext& context = *job.context;
  for (std::size_t i = 0; i < context.value.size(); ++i) {
    context.value[i] = Saturate(job.input[i]);
    context.raw[i] = Saturate(job.input[i]);
    context.derivative[i] = 0.0f;
  }
  context.since_input = 0.0;
  context.started = true;
}

void Follow(const FilterJob& job) {
  const Filter& filter = *job.filter;
  FilterContext& context = *job.context;
  const OneEuro one_euro{.min_cutoff_hz = filter.min_cutoff_hz,
                         .beta = filter.beta,
                         .derivative_cutoff_hz = filter.derivative_cutoff_hz};
  const double since_raw = context.since_input + job.dt;  // spans a loss of input too
  for (std::size_t i = 0; i < context.value.size(); ++i) {
    const double input = Saturate(job.input[i]);
    const double slope = (input - context.raw[i]) / since_raw;
    double speed = context.derivative[i];
    const float smooth =
        static_cast<float>(one_euro.Step(context.value[i], input, slope, job.dt, &speed));
    context.value[i] =
        Saturate(LimitSlew(context.value[i], smooth, filter.slew_per_second, job.dt));
    context.derivative[i] = static_cast<float>(speed);
    context.raw[i] = Saturate(job.input[i]);
  }
  context.since_input = 0.0;
}

void HoldAndDecay(const FilterJob& job) {
  const Filter& filter = *job.filter;
  FilterContext& context = *job.context;
  context.since_input += job.dt;
  const double decaying = std::min(job.dt, context.since_input - double{filter.hold_seconds});
  if (decaying <= 0.0) return;
  const double share =
      filter.decay_seconds > 0.0f ? std::exp(-decaying / double{filter.decay_seconds}) : 0.0;
  for (std::size_t i = 0; i < context.value.size(); ++i) {
    const float target = static_cast<float>(context.value[i] * share);
    const float next = LimitSlew(context.value[i], target, filter.slew_per_second, job.dt);
    context.value[i] = next < kNeutral ? 0.0f : next;
    context.derivative[i] = 0.0f;
  }
}

}  // namespace

void FilterContext::Resize(int num_values) {
  const std::size_t count = static_cast<std::size_t>(num_values);
  value.assign(count, 0.0f);
  raw.assign(count, 0.0f);
  derivative.assign(count, 0.0f);
  since_input = 0.0;
  started = false;
}

void FilterContext::Reset() { Resize(static_cast<int>(value.size())); }

JobStatus FilterJob::Validate() const {
  if (filter == nullptr || context == nullptr) return JobStatus::kNullPointer;
  if (!std::isfinite(dt) || dt < 0.0) return JobStatus::kBadTime;
  const std::size_t count = context->value.size();
  if (!input.empty() && input.size() != count) return JobStatus::kSizeMismatch;
  if (output.size() < count) return JobStatus::kSizeMismatch;
  return AllFinite(input) ? JobStatus::kOk : JobStatus::kNonFinite;
}

JobStatus FilterJob::Run() const {
  if (const JobStatus status = Validate(); status != JobStatus::kOk) return status;
  if (input.empty()) {
    if (context->started) HoldAndDecay(*this);
  } else {
    switch (MoveOn(*filter, *context, dt)) {
      case FilterMove::kStart: Start(*this); break;
      case FilterMove::kFollow: Follow(*this); break;
      case FilterMove::kStay: break;
    }
  }
  if (output.data() != context->value.data()) {
    std::copy(context->value.begin(), context->value.end(), output.begin());
  }
  return JobStatus::kOk;
}

}  // namespace furrow::wrinkle

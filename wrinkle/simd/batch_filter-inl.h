// SPDX-License-Identifier: Apache-2.0
// The filter of one subject, along its driver values.
#if defined(FURROW_WRINKLE_BATCH_FILTER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FURROW_WRINKLE_BATCH_FILTER_INL_H_
#undef FURROW_WRINKLE_BATCH_FILTER_INL_H_
#else
#define FURROW_WRINKLE_BATCH_FILTER_INL_H_
#endif

#include <algorithm>

#include "base/scalar.h"
#include "wrinkle/simd/batch_kernel.h"
#include "wrinkle/simd/batch_lanes-inl.h"
#include "wrinkle/weights/filter_move.h"

HWY_BEFORE_NAMESPACE();
namespace furrow::wrinkle::HWY_NAMESPACE {

// One filter's parameters and times (FilterJob), as its formulas need them: with s the share that
// the derivative takes over, speed = s / since * (input - last input) + (1 - s) * last speed, and
// LowPassShare() is c / (1 + c) with c = angle * (min_cutoff + beta * |speed|).
struct FilterLanes {
  Float slope_share, speed_left, c_least, c_of_speed, largest_change, largest_fall;
};

HWY_INLINE FilterLanes MakeFilterLanes(const Filter& filter, double since_input, double dt) {
  const double angle = 2.0 * double{kPi} * std::min(dt, 1e20);  // then c / (1 + c) has long been 1
  const double derivative = angle * double{filter.derivative_cutoff_hz};
  const double since = since_input + dt;
  const bool limited = filter.slew_per_second > 0.0f;
  const double largest_change = limited ? double{filter.slew_per_second} * dt : 2.0;
  const auto splat = [](double x) HWY_ATTR { return Splat(static_cast<float>(x)); };
  return {.slope_share = splat(derivative / ((1.0 + derivative) * since)),
          .speed_left = splat(1.0 / (1.0 + derivative)),
          .c_least = splat(angle * double{filter.min_cutoff_hz}),
          .c_of_speed = splat(angle * double{filter.beta}),
          .largest_change = splat(largest_change),
          .largest_fall = splat(-largest_change)};
}

// A filter's numbers of as many values as there are lanes.
struct FilterState {
  Float raw, value, derivative;
};

// OneEuro::Step() and the slew limit.
HWY_INLINE FilterState Follow(const FilterLanes& f, FilterState old, Float input) {
  const Float slope = hn::Mul(f.slope_share, hn::Sub(input, old.raw));
  const Float speed = hn::MulAdd(f.speed_left, old.derivative, slope);
  const Float c = hn::MulAdd(f.c_of_speed, hn::Abs(speed), f.c_least);
  const Float most = hn::Mul(c, hn::Sub(input, old.value));
  const Float wanted = hn::Div(most, hn::Add(c, Splat(1.0f)));
  const Float change = hn::Max(hn::Min(wanted, f.largest_change), f.largest_fall);
  return {input, SaturateNumber(hn::Add(old.value, change)), speed};
}

// Calls `function` with each row of driver values, in the order of the rig (0 beyond the level of
// detail), and where it begins. `rows`: what the drivers have come to (LanePlan).
template <class Function>
HWY_INLINE void ForEachInput(const SubjectJob& job, const float* rows, Function function) {
  const Floats d;
  const Gatherer gatherer(job.binding->lanes.values);
  const std::size_t num_values = job.num_values;
  const std::size_t num_rows = job.binding->lanes.values.num_rows();
  for (std::size_t row = 0; row < num_rows; ++row) {
    for (std::size_t lane = 0; lane < kRowLanes; lane += kLanes) {
      const std::size_t first = row * kRowLanes + lane;
      Float values = hn::Zero(d);
      if (first < num_values) values = gatherer.Row(row, lane, rows);
      if (first + kLanes > num_values && first < num_values) {
        values = hn::IfThenElseZero(hn::FirstN(d, num_values - first), values);
      }
      function(values, first);
    }
  }
}

// FilterJob.
inline void FilterSubject(const SubjectJob& job, const FilterLanes& filter, const float* rows) {
  const FilterLanes lanes = filter;
  FilterContext* const context = job.context;
  float* const raw = context->raw.data();
  float* const value = context->value.data();
  float* const derivative = context->derivative.data();
  float* const apart = job.raw_values;
  const FilterMove move = MoveOn(*job.filter, *context, job.dt);
  *job.is_apart = move == FilterMove::kStay;
  switch (move) {
    case FilterMove::kStay:
      ForEachInput(job, rows,
                   [=](Float input, std::size_t i) HWY_ATTR { StoreLanes(input, apart + i); });
      return;
    case FilterMove::kStart:
      ForEachInput(job, rows, [=](Float input, std::size_t i) HWY_ATTR {
        StoreLanes(input, value + i);
        StoreLanes(input, raw + i);
        StoreLanes(hn::Zero(Floats()), derivative + i);
      });
      context->started = true;
      break;
    case FilterMove::kFollow:
      ForEachInput(job, rows, [=](Float input, std::size_t i) HWY_ATTR {
        const FilterState old{LoadLanes(raw + i), LoadLanes(value + i), LoadLanes(derivative + i)};
        const FilterState now = Follow(lanes, old, input);
        StoreLanes(now.raw, raw + i);
        StoreLanes(now.value, value + i);
        StoreLanes(now.derivative, derivative + i);
      });
      break;
  }
  context->since_input = 0.0;
}

}  // namespace furrow::wrinkle::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard

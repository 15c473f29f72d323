// SPDX-License-Identifier: Apache-2.0
// The filter of one subject, one driver value per lane: One-Euro (Casiez, Roussel and Vogel 2012)
// and a slew limit.
#if defined(FURROW_WRINKLE_FILTER_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FURROW_WRINKLE_FILTER_LANES_INL_H_
#undef FURROW_WRINKLE_FILTER_LANES_INL_H_
#else
#define FURROW_WRINKLE_FILTER_LANES_INL_H_
#endif

#include <algorithm>
#include <cmath>

#include "base/scalar.h"
#include "wrinkle/simd/lane_math-inl.h"
#include "wrinkle/weights/filter.h"

HWY_BEFORE_NAMESPACE();
namespace furrow::wrinkle::HWY_NAMESPACE {

// A filter's parameters and times in the form that Follow() needs. Between two inputs, the input is
// taken as a straight line, and both low-passes are solved exactly for it, so that the result
// hardly depends on the frame rate:
//
// - slope      = (input - last input) / since, in 1/s
// - speed'     = a_d (slope - speed), a_d = 2 pi derivative_cutoff, is an exponential. `speed_left`
//                is exp(-a_d dt); `mean_left` is the mean of that exponential over dt.
// - value'     = a (line - value), a = 2 pi (min_cutoff + beta |mean speed|), with c = a dt:
//                value += rise (1 - (1 - exp(-c)) / c) + (line at the start - value) (1 - exp(-c)),
//                where rise = slope dt.
struct FilterLanes {
  Float inverse_since, dt;
  Float speed_left, speed_share, mean_left, mean_share;  // of the last speed and of the slope
  Float c_least, c_of_speed, largest_change, largest_fall;
};

HWY_INLINE FilterLanes MakeFilterLanes(const Filter& filter, double since_input, double dt) {
  const double angle = 2.0 * double{kPi} * std::min(dt, 1e20);  // exp(-angle) is 0 long before
  const double derivative = angle * double{filter.derivative_cutoff_hz};
  const double share = -std::expm1(-derivative);
  const double mean_left = share / derivative;
  // The slope is measured over all time since the last input, including time without input. If it
  // is 0, the infinite share stays unused: MoveOn() returns kStay.
  const double since = since_input + dt;
  const bool limited = filter.slew_per_second > 0.0f;
  // Values are in [0, 1], so a limit of 2 never acts.
  const double largest_change = limited ? double{filter.slew_per_second} * dt : 2.0;
  const auto splat = [](double x) HWY_ATTR { return Splat(static_cast<float>(x)); };
  return {.inverse_since = splat(1.0 / since),
          .dt = splat(std::min(dt, 1e20)),
          .speed_left = splat(1.0 - share),
          .speed_share = splat(share),
          .mean_left = splat(mean_left),
          .mean_share = splat(1.0 - mean_left),
          .c_least = splat(angle * double{filter.min_cutoff_hz}),
          .c_of_speed = splat(angle * double{filter.beta}),
          .largest_change = splat(largest_change),
          .largest_fall = splat(-largest_change)};
}

// The state of kLanes values.
struct FilterState {
  Float raw, value, derivative;
};

// One step of One-Euro and the slew limit.
HWY_INLINE FilterState Follow(const FilterLanes& f, FilterState old, Float input) {
  const Float slope = hn::Mul(hn::Sub(input, old.raw), f.inverse_since);
  // Sums of shares: a difference would lose digits where the slope is large.
  const Float speed = hn::MulAdd(f.speed_left, old.derivative, hn::Mul(f.speed_share, slope));
  const Float mean_speed = hn::MulAdd(f.mean_left, old.derivative, hn::Mul(f.mean_share, slope));
  const Float c = hn::MulAdd(f.c_of_speed, hn::Abs(mean_speed), f.c_least);
  const Float reached = OneMinusExponential(c);
  // min() guards c of a time so short that its share is lost anyway.
  const Float lag = hn::Sub(Splat(1.0f), hn::Min(hn::Div(reached, c), Splat(1.0f)));
  const Float rise = hn::Mul(slope, f.dt);
  const Float start = hn::Sub(hn::Sub(input, rise), old.value);
  const Float wanted = hn::MulAdd(rise, lag, hn::Mul(start, reached));
  const Float change = hn::Max(hn::Min(wanted, f.largest_change), f.largest_fall);
  return {input, SaturateNumber(hn::Add(old.value, change)), speed};
}

// A subject's part of the filter.
struct FilterStep {
  const Filter& filter;
  const FilterLanes& lanes;
  double dt;
  const RowGather& inputs;  // brings the inputs into the order of the rig
  std::size_t num_inputs;   // the values from here on are 0 (level of detail)
  FilterContext* context;
  float* raw_values;  // receives the inputs if the filter does not move (FilterMove::kStay)
  bool* is_apart;     // true if it did
};

// Calls `function` with each vector of inputs in the order of the rig, and with its first index.
template <class Function>
HWY_INLINE void ForEachInput(const FilterStep& step, const float* rows, Function function) {
  const Floats d;
  const Gatherer gatherer(step.inputs);
  const std::size_t num_values = step.num_inputs;
  const std::size_t num_rows = step.inputs.num_rows();
  for (std::size_t row = 0; row < num_rows; ++row) {
    for (std::size_t lane = 0; lane < kRowLanes; lane += kLanes) {
      const std::size_t first = row * kRowLanes + lane;
      Float values = hn::Zero(d);
      if (first < num_values) values = gatherer.Row(row, lane, rows);
      // The vector in which the level of detail ends: clear the lanes behind it.
      if (first + kLanes > num_values && first < num_values) {
        values = hn::IfThenElseZero(hn::FirstN(d, num_values - first), values);
      }
      function(values, first);
    }
  }
}

// `rows`: the driver values in the scratch memory.
inline void FilterValues(const FilterStep& step, const float* rows) {
  const FilterLanes lanes = step.lanes;
  FilterContext* const context = step.context;
  float* const raw = context->raw.data();
  float* const value = context->value.data();
  float* const derivative = context->derivative.data();
  float* const apart = step.raw_values;
  const FilterMove move = MoveOn(step.filter, *context, step.dt);
  *step.is_apart = move == FilterMove::kStay;
  switch (move) {
    case FilterMove::kStay:
      // The filter has seen this instant, so it keeps its state. SubjectSolver::driver_values()
      // reads the new values.
      ForEachInput(step, rows,
                   [=](Float input, std::size_t i) HWY_ATTR { StoreLanes(input, apart + i); });
      return;
    case FilterMove::kStart:
      ForEachInput(step, rows, [=](Float input, std::size_t i) HWY_ATTR {
        StoreLanes(input, value + i);
        StoreLanes(input, raw + i);
        StoreLanes(hn::Zero(Floats()), derivative + i);
      });
      context->started = true;
      break;
    case FilterMove::kFollow:
      ForEachInput(step, rows, [=](Float input, std::size_t i) HWY_ATTR {
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

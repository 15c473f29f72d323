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
//
// Single numbers, because vectors of them would be copied through memory several times.
struct FilterFactors {
  float inverse_since, dt;
  float speed_left, speed_share, mean_left, mean_share;  // of the last speed and of the slope
  float c_least, c_of_speed, largest_change;
};

HWY_INLINE FilterFactors MakeFilterFactors(const Filter& filter, double since_input, double dt) {
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
  const auto single = [](double x) { return static_cast<float>(x); };
  return {.inverse_since = single(1.0 / since),
          .dt = single(std::min(dt, 1e20)),
          .speed_left = single(1.0 - share),
          .speed_share = single(share),
          .mean_left = single(mean_left),
          .mean_share = single(1.0 - mean_left),
          .c_least = single(angle * double{filter.min_cutoff_hz}),
          .c_of_speed = single(angle * double{filter.beta}),
          .largest_change = single(largest_change)};
}

// A subject's part of the filter.
struct FilterStep {
  const Filter& filter;
  const FilterFactors& factors;
  double dt;
  const RowGather& inputs;  // brings the inputs into the order of the rig
  std::size_t num_inputs;   // the values from here on are 0 (level of detail)
  FilterContext* context;
  float* raw_values;  // receives the inputs if the filter does not move (FilterMove::kStay)
  bool* is_apart;     // true if it did
  float* scratch;     // kFilterRows rows per row of inputs
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

// One-Euro and the slew limit in three passes over all values. In a single pass, each operation of
// a long chain would wait for the one before it, and processors do not look far enough ahead to
// compute several such chains at once.
inline void Follow(const FilterStep& step, const float* rows) {
  const FilterFactors f = step.factors;
  float* const raw = step.context->raw.data();
  float* const value = step.context->value.data();
  float* const derivative = step.context->derivative.data();
  const std::size_t size = step.inputs.num_rows() * kRowLanes;
  float* const rises = step.scratch;  // slope dt
  float* const cs = rises + size;
  float* const shares = cs + size;  // 1 - exp(-c)
  ForEachInput(step, rows, [=](Float input, std::size_t i) HWY_ATTR {
    const Float slope = hn::Mul(hn::Sub(input, LoadLanes(raw + i)), Splat(f.inverse_since));
    const Float old_speed = LoadLanes(derivative + i);
    // Sums of shares: a difference would lose digits where the slope is large.
    const Float speed =
        hn::MulAdd(Splat(f.speed_left), old_speed, hn::Mul(Splat(f.speed_share), slope));
    const Float mean_speed =
        hn::MulAdd(Splat(f.mean_left), old_speed, hn::Mul(Splat(f.mean_share), slope));
    StoreLanes(input, raw + i);
    StoreLanes(speed, derivative + i);
    StoreLanes(hn::Mul(slope, Splat(f.dt)), rises + i);
    StoreLanes(hn::MulAdd(Splat(f.c_of_speed), hn::Abs(mean_speed), Splat(f.c_least)), cs + i);
  });
  for (std::size_t i = 0; i < size; i += kLanes) {
    StoreLanes(OneMinusExponential(LoadLanes(cs + i)), shares + i);
  }
  for (std::size_t i = 0; i < size; i += kLanes) {
    const Float reached = LoadLanes(shares + i);
    // min() guards c of a time so short that its share is lost anyway.
    const Float lag =
        hn::Sub(Splat(1.0f), hn::Min(hn::Div(reached, LoadLanes(cs + i)), Splat(1.0f)));
    const Float rise = LoadLanes(rises + i);
    const Float old_value = LoadLanes(value + i);
    const Float start = hn::Sub(hn::Sub(LoadLanes(raw + i), rise), old_value);
    const Float wanted = hn::MulAdd(rise, lag, hn::Mul(start, reached));
    const Float change =
        hn::Max(hn::Min(wanted, Splat(f.largest_change)), Splat(-f.largest_change));
    StoreLanes(SaturateNumber(hn::Add(old_value, change)), value + i);
  }
}

// `rows`: the driver values in the scratch memory.
inline void FilterValues(const FilterStep& step, const float* rows) {
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
    case FilterMove::kFollow: Follow(step, rows); break;
  }
  context->since_input = 0.0;
}

}  // namespace furrow::wrinkle::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard

// SPDX-License-Identifier: Apache-2.0
// What follows the drivers: the filter, whose vectors run along one subject's values (they share
// its times and parameters), and the wrinkle weights, again one subject a lane.
#if defined(FURROW_WRINKLE_BATCH_WEIGHTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FURROW_WRINKLE_BATCH_WEIGHTS_INL_H_
#undef FURROW_WRINKLE_BATCH_WEIGHTS_INL_H_
#else
#define FURROW_WRINKLE_BATCH_WEIGHTS_INL_H_
#endif

#include <algorithm>

#include "wrinkle/batch_math-inl.h"
#include "wrinkle/filter_move.h"
#include "wrinkle/modulation.h"
#include "wrinkle/scalar.h"

HWY_BEFORE_NAMESPACE();
namespace furrow::wrinkle::HWY_NAMESPACE {

// One filter's parameters and times (FilterJob), as its formulas need them.
struct FilterLanes {
  Float derivative_share, inverse_since, min_cutoff, beta, angle, largest_change;
};

HWY_INLINE FilterLanes MakeFilterLanes(const Filter& filter, double since_input, double dt) {
  const double angle = 2.0 * double{kPi} * dt;  // LowPassShare() is c / (1 + c), c = angle * cutoff
  const double derivative = angle * double{filter.derivative_cutoff_hz};
  const bool limited = filter.slew_per_second > 0.0f;
  return {.derivative_share = Splat(static_cast<float>(derivative / (1.0 + derivative))),
          .inverse_since = Splat(static_cast<float>(1.0 / (since_input + dt))),
          .min_cutoff = Splat(filter.min_cutoff_hz),
          .beta = Splat(filter.beta),
          .angle = Splat(static_cast<float>(angle)),
          .largest_change = limited ? Splat(static_cast<float>(double{filter.slew_per_second} * dt))
                                    : Splat(2.0f)};
}

// A filter's numbers of as many values as there are lanes.
struct FilterState {
  Float raw, value, derivative;
};

// OneEuro::Step() and the slew limit.
HWY_INLINE FilterState Follow(const FilterLanes& f, FilterState old, Float input) {
  const Float slope = hn::Mul(hn::Sub(input, old.raw), f.inverse_since);
  const Float speed =
      hn::MulAdd(f.derivative_share, hn::Sub(slope, old.derivative), old.derivative);
  const Float cutoff = hn::MulAdd(f.beta, hn::Abs(speed), f.min_cutoff);
  const Float c = hn::Mul(f.angle, cutoff);
  const Float share = hn::Div(c, hn::Add(c, Splat(1.0f)));
  const Float wanted = hn::Mul(share, hn::Sub(input, old.value));
  const Float change = hn::Max(hn::Min(wanted, f.largest_change), hn::Neg(f.largest_change));
  return {input, Saturate(hn::Add(old.value, change)), speed};
}

// All values of a subject; they fill whole vectors.
inline void FollowAll(const Filter& filter, FilterContext* context, double dt, const float* input) {
  const Floats d;
  const FilterLanes lanes = MakeFilterLanes(filter, context->since_input, dt);
  const std::size_t count = context->value.size();
  float* const raw = context->raw.data();
  float* const value = context->value.data();
  float* const derivative = context->derivative.data();
  for (std::size_t i = 0; i < count; i += kLanes) {
    const FilterState old{hn::LoadU(d, raw + i), hn::LoadU(d, value + i),
                          hn::LoadU(d, derivative + i)};
    const FilterState now = Follow(lanes, old, hn::LoadU(d, input + i));
    hn::StoreU(now.raw, d, raw + i);
    hn::StoreU(now.value, d, value + i);
    hn::StoreU(now.derivative, d, derivative + i);
  }
}

// FilterJob for one subject of the group.
inline void FilterSubject(const BatchGroup& group, std::size_t subject) {
  const Filter& filter = *group.filters[subject];
  FilterContext* const context = group.contexts[subject];
  const float* const input = group.raw_values[subject];
  const FilterMove move = MoveOn(filter, *context, group.dt[subject]);
  if (move == FilterMove::kStay) return;
  if (move == FilterMove::kStart) {
    const std::size_t count = context->value.size();
    std::copy(input, input + count, context->value.begin());
    std::copy(input, input + count, context->raw.begin());
    std::fill(context->derivative.begin(), context->derivative.end(), 0.0f);
    context->started = true;
  } else {
    FollowAll(filter, context, group.dt[subject], input);
  }
  context->since_input = 0.0;
}

HWY_INLINE Float LaneModulate(Modulation modulation, Float x) {
  switch (modulation) {
    case Modulation::kCosine: return CosineCurve(x);
    case Modulation::kCubic:
      return Saturate(hn::Mul(x, Polynomial(x, 3.26168f, -4.87773f, 2.62235f)));
    case Modulation::kLinear: break;
  }
  return x;
}

// WeightTable::Modulated(); `values` in rows of kLanes.
inline Float ModulatedWeight(const WeightTable& table, int weight, const float* values) {
  Float largest = hn::Zero(Floats());
  Float sum = largest;
  float gains = 0.0f;
  for (const WeightSource& source : table.sources(weight)) {
    const float* const row = values + static_cast<std::size_t>(source.driver_value) * kLanes;
    const Float term = hn::Mul(Splat(source.gain), LoadLanes(row));
    largest = hn::Max(largest, term);
    sum = hn::Add(sum, term);
    gains += source.gain;
  }
  switch (table.combine(weight)) {
    case Combine::kMax: break;
    case Combine::kSum: largest = sum; break;
    case Combine::kMean: largest = gains > 0.0f ? hn::Div(sum, Splat(gains)) : Splat(0.0f); break;
  }
  return LaneModulate(table.modulation(weight), Saturate(largest));
}

// CongruenceFactor().
HWY_INLINE Float LaneCongruence(Float own, Float other) {
  const Float sum = hn::Add(own, other);
  const Float factor = Smoothstep(-0.5f, 0.5f, hn::Div(hn::Sub(own, other), sum));
  return hn::IfThenElse(hn::Gt(sum, hn::Zero(Floats())), factor, Splat(1.0f));
}

HWY_INLINE Float CongruentWeight(const WeightTable& table, std::size_t weight,
                                 const float* modulated) {
  const Float own = LoadLanes(modulated + weight * kLanes);
  Float factor = Splat(1.0f);
  for (const std::uint16_t opponent : table.opponents(static_cast<int>(weight))) {
    const Float other = LoadLanes(modulated + std::size_t{opponent} * kLanes);
    factor = hn::Mul(factor, LaneCongruence(own, other));
  }
  return hn::Mul(own, factor);
}

}  // namespace furrow::wrinkle::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard

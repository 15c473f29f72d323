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
#include <cstring>

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

// OneEuro::Step() and the slew limit on as many values as there are lanes.
HWY_INLINE void Follow(const FilterLanes& f, const float* input, float* raw, float* value,
                       float* derivative) {
  const Floats d;
  const Float in = hn::LoadU(d, input);
  const Float before = hn::LoadU(d, value);
  const Float old_speed = hn::LoadU(d, derivative);
  const Float slope = hn::Mul(hn::Sub(in, hn::LoadU(d, raw)), f.inverse_since);
  const Float speed = hn::MulAdd(f.derivative_share, hn::Sub(slope, old_speed), old_speed);
  const Float cutoff = hn::MulAdd(f.beta, hn::Abs(speed), f.min_cutoff);
  const Float c = hn::Mul(f.angle, cutoff);
  const Float share = hn::Div(c, hn::Add(c, Splat(1.0f)));
  const Float wanted = hn::Mul(share, hn::Sub(in, before));
  const Float change = hn::Max(hn::Min(wanted, f.largest_change), hn::Neg(f.largest_change));
  hn::StoreU(Saturate(hn::Add(before, change)), d, value);
  hn::StoreU(speed, d, derivative);
  hn::StoreU(in, d, raw);
}

inline void FollowAll(const Filter& filter, FilterContext* context, double dt, const float* input) {
  const FilterLanes lanes = MakeFilterLanes(filter, context->since_input, dt);
  const std::size_t count = context->value.size();
  float* const raw = context->raw.data();
  float* const value = context->value.data();
  float* const derivative = context->derivative.data();
  std::size_t i = 0;
  for (; i + kLanes <= count; i += kLanes) {
    Follow(lanes, input + i, raw + i, value + i, derivative + i);
  }
  if (i == count) return;
  float rest[4][kLanes] = {};
  const std::size_t bytes = (count - i) * sizeof(float);
  std::memcpy(rest[0], input + i, bytes);
  std::memcpy(rest[1], raw + i, bytes);
  std::memcpy(rest[2], value + i, bytes);
  std::memcpy(rest[3], derivative + i, bytes);
  Follow(lanes, rest[0], rest[1], rest[2], rest[3]);
  std::memcpy(raw + i, rest[1], bytes);
  std::memcpy(value + i, rest[2], bytes);
  std::memcpy(derivative + i, rest[3], bytes);
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

// SPDX-License-Identifier: Apache-2.0
// Turns driver values into wrinkle weights, one weight per lane: combines and
// modulates (thesis 4.3, 4.4), then resolves incongruence (docs/ALGORITHM.md).
#if defined(FURROW_WRINKLE_WEIGHT_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FURROW_WRINKLE_WEIGHT_LANES_INL_H_
#undef FURROW_WRINKLE_WEIGHT_LANES_INL_H_
#else
#define FURROW_WRINKLE_WEIGHT_LANES_INL_H_
#endif

#include <algorithm>
#include <span>

#include "wrinkle/simd/lane_math-inl.h"
#include "wrinkle/weights/weight_plan.h"

HWY_BEFORE_NAMESPACE();
namespace furrow::wrinkle::HWY_NAMESPACE {

// The value at `x`, in [0, 1], of the curve of each lane; 0 in lanes without a curve. Every lane
// takes the last of its pieces that begins at or before `x`.
HWY_INLINE Float FreeCurve(std::span<const CurveRow> pieces, std::size_t lane, Float x) {
  Float from = hn::Zero(Floats());
  Float c[4] = {from, from, from, from};
  for (const CurveRow& piece : pieces) {
    const Float start = LoadRow(piece.from, lane);
    const Mask is_reached = hn::Ge(x, start);
    from = hn::IfThenElse(is_reached, start, from);
    for (std::size_t k = 0; k < 4; ++k) {
      c[k] = hn::IfThenElse(is_reached, LoadRow(piece.c[k], lane), c[k]);
    }
  }
  const Float t = hn::Sub(x, from);
  // Rounding may leave [0, 1] by a few units in the last place.
  return Saturate(hn::MulAdd(hn::MulAdd(hn::MulAdd(c[3], t, c[2]), t, c[1]), t, c[0]));
}

// `x` in [0, 1]. Cosine: (1 - cos(pi x)) / 2. Cubic: 2.62235 x - 4.87773 x^2 + 3.26168 x^3,
// clamped.
HWY_INLINE Float Modulate(const ModulationRow& modulation, std::size_t lane, Float x) {
  if (modulation.all_cosine) return CosineCurve(x);
  Float modulated = hn::IfThenElse(LoadMask(modulation.is_cosine, lane), CosineCurve(x), x);
  if (modulation.any_cubic) {
    const Float cubic = Saturate(hn::Mul(x, Polynomial(x, 3.26168f, -4.87773f, 2.62235f)));
    modulated = hn::IfThenElse(LoadMask(modulation.is_cubic, lane), cubic, modulated);
  }
  if (!modulation.curve.empty()) {
    const Float curve = FreeCurve(modulation.curve, lane, x);
    modulated = hn::IfThenElse(LoadMask(modulation.is_curve, lane), curve, modulated);
  }
  return modulated;
}

inline void ModulateLanes(const ModulationRow& modulation, float* row) {
  for (std::size_t lane = 0; lane < kRowLanes; lane += kLanes) {
    StoreLanes(Modulate(modulation, lane, LoadLanes(row + lane)), row + lane);
  }
}

// Combines the sources of a block's weights, and modulates the result (Combine).
HWY_INLINE Float ModulatedWeights(const WeightBlock& block, Gatherer sources, const FloatRow* gains,
                                  std::size_t lane, const float* values) {
  const auto term = [&](std::uint32_t i) HWY_ATTR {
    return hn::Mul(sources.Row(i, lane, values), LoadRow(gains[i], lane));
  };
  const std::uint32_t first = block.first_source;
  const std::uint32_t end = first + block.num_sources;
  Float largest = hn::Zero(Floats());
  if (block.takes_largest) {  // the common case; values are in [0, 1]
    for (std::uint32_t i = first; i != end; ++i) {
      largest = hn::Max(largest, sources.Row(i, lane, values));
    }
    return Modulate(block.modulation, lane, largest);
  }
  for (std::uint32_t i = first; i != end; ++i) largest = hn::Max(largest, term(i));
  if (!block.all_max) {
    Float sum = hn::Zero(Floats());
    for (std::uint32_t i = first; i != end; ++i) sum = hn::Add(sum, term(i));
    const Float scaled = hn::Mul(sum, LoadRow(block.scale, lane));
    largest = hn::IfThenElse(LoadMask(block.is_max, lane), largest, scaled);
  }
  const Float combined = Modulate(block.modulation, lane, Saturate(largest));
  if (!block.any_sum_modulated) return combined;
  // 4.2 modulates every source by itself. Missing sources have a gain of 0.
  Float sum = hn::Zero(Floats());
  for (std::uint32_t i = first; i != end; ++i) {
    const Float source = Modulate(block.modulation, lane, sources.Row(i, lane, values));
    sum = hn::Add(sum, hn::Mul(source, LoadRow(gains[i], lane)));
  }
  return hn::IfThenElse(LoadMask(block.is_sum_modulated, lane), Saturate(sum), combined);
}

inline void ModulateAll(const WeightPlan& plan, const float* values, float* modulated) {
  const Gatherer sources(plan.sources);
  const FloatRow* const gains = plan.gains.data();
  const std::span<const WeightBlock> blocks = plan.blocks;
  for (const WeightBlock& block : blocks) {
    for (std::size_t lane = 0; lane < kRowLanes; lane += kLanes, modulated += kLanes) {
      StoreLanes(ModulatedWeights(block, sources, gains, lane, values), modulated);
    }
  }
}

// The factor by which an opposed weight of a neighbouring region reduces a weight:
// smoothstep(-1/2, 1/2, (own - other) / (own + other)); 1 if both are 0.
HWY_INLINE Float CongruenceFactor(Float own, Float other) {
  // 0 / 0 is NaN where both weights are 0; the last line replaces it.
  const Float sum = hn::Add(own, other);
  const Float factor = Smoothstep(-0.5f, 0.5f, hn::Div(hn::Sub(own, other), sum));
  return hn::IfThenElse(hn::Gt(sum, hn::Zero(Floats())), factor, Splat(1.0f));
}

HWY_INLINE Float CongruentWeights(const WeightBlock& block, Gatherer opponents, std::size_t lane,
                                  Float own, const float* modulated) {
  Float factor = Splat(1.0f);
  for (std::uint32_t i = 0; i < block.num_opponents; ++i) {
    const Float other = opponents.Row(block.first_opponent + i, lane, modulated);
    factor = hn::Mul(factor, CongruenceFactor(own, other));
  }
  return hn::Mul(own, factor);
}

// `modulated`: scratch memory of plan.num_rows() rows.
inline void EvaluateWeights(const WeightPlan& plan, const float* values, float* modulated,
                            float* weights) {
  if (plan.opponents.num_rows() == 0) return ModulateAll(plan, values, weights);
  ModulateAll(plan, values, modulated);
  const std::span<const WeightBlock> blocks = plan.blocks;
  // The row of zeros behind the last weight stands for no opponent. Against 0, CongruenceFactor()
  // is 1.
  std::fill_n(modulated + blocks.size() * kRowLanes, kRowLanes, 0.0f);
  const Gatherer opponents(plan.opponents);
  const float* own = modulated;
  for (const WeightBlock& block : blocks) {
    for (std::size_t lane = 0; lane < kRowLanes; lane += kLanes) {
      const Float from = LoadLanes(own);
      StoreLanes(CongruentWeights(block, opponents, lane, from, modulated), weights);
      own += kLanes;
      weights += kLanes;
    }
  }
}

// CongruenceFactor() of one pair, for Explain().
inline float CongruenceOf(float own, float other) {
  return hn::GetLane(CongruenceFactor(Splat(own), Splat(other)));
}

}  // namespace furrow::wrinkle::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard

// SPDX-License-Identifier: Apache-2.0
// The group solver, compiled once for each instruction set and chosen at run time: Highway includes
// this file again and again. SSSE3 is left out (processors that have it but not
// SSE4 are rare), and so are vectors without a fixed size (SVE, RVV), which no struct can hold.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "wrinkle/batch_kernel.cpp"
#include "wrinkle/batch_kernel.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "wrinkle/batch_poses-inl.h"
#include "wrinkle/batch_weights-inl.h"
#include "wrinkle/driver_values.h"
#include "wrinkle/finite.h"

HWY_BEFORE_NAMESPACE();
namespace furrow::wrinkle::HWY_NAMESPACE {

// Rows are transposed four at a time.
inline std::size_t NumValueRows(const BindingData& data) {
  return (static_cast<std::size_t>(data.first_values.back()) + 3) / 4 * 4;
}

// Evaluates those entries, in the rig's order, that the group's level of detail reaches.
template <class Entry, class Evaluate>
HWY_INLINE void EvaluateEach(std::span<const Entry> entries, const BatchGroup& group, float* rows,
                             Evaluate evaluate) {
  for (const Entry& entry : entries) {
    const auto first_value = static_cast<std::size_t>(entry.first_value);
    if (first_value >= group.num_values) return;
    evaluate(entry, rows + first_value * kLanes);
  }
}

unsigned SuspectLanes(Float check, std::size_t count) {
  HWY_ALIGN float numbers[kLanes];
  StoreLanes(check, numbers);
  unsigned suspect = 0;
  for (std::size_t lane = 0; lane < count; ++lane) {
    if (!(numbers[lane] == 0.0f)) suspect |= 1u << lane;
  }
  return suspect;
}

// The values of all drivers but nnls and strain, in rows. Returns what EvaluateGroup() does.
unsigned EvaluateRows(const BatchGroup& group, float* rows) {
  const BindingData& data = *group.binding;
  const JointChains& chains = data.chains;
  PoseLanes lanes{group.joints.data(), hn::Zero(Floats())};
  std::fill_n(rows, NumValueRows(data) * kLanes, 0.0f);
  EvaluateEach(data.pose_drivers.entries(), group, rows,
               [&](const PoseDriverSet::Entry& entry, float* values) HWY_ATTR {
                 if (entry.solve == PoseSolve::kNnls) return;
                 EvaluatePose(data.pose_drivers, entry, chains, &lanes, values);
               });
  EvaluateEach(data.hinge_drivers.entries(), group, rows,
               [&](const HingeDriverSet::Entry& entry, float* values)
                   HWY_ATTR { EvaluateHinge(entry, chains, &lanes, values); });
  EvaluateEach(data.ball_drivers.entries(), group, rows,
               [&](const BallDriverSet::Entry& entry, float* values)
                   HWY_ATTR { EvaluateBall(entry, chains, &lanes, values); });
  EvaluateEach(data.twist_drivers.entries(), group, rows,
               [&](const TwistDriverSet::Entry& entry, float* values) HWY_ATTR {
                 EvaluateTwist(entry, data.twist_drivers.joints(entry), &lanes, values);
               });
  EvaluateEach(data.blend_shape_drivers.entries(), group, rows,
               [&](const BlendShapeDriverSet::Entry& entry, float* values)
                   HWY_ATTR { EvaluateBlendShape(entry, group.blend_shapes.data(), values); });
  return SuspectLanes(lanes.check, group.count);
}

HWY_INLINE Columns LoadRows(const float* row) {
  return {LoadLanes(row), LoadLanes(row + kLanes), LoadLanes(row + 2 * kLanes),
          LoadLanes(row + 3 * kLanes)};
}

// Rows to each subject's own list.
void StoreValues(const BatchGroup& group, std::size_t num_rows, const float* rows) {
  for (std::size_t i = 0; i < num_rows; i += 4) {
    StoreColumns(LoadRows(rows + i * kLanes), group.raw_values.data(), i);
  }
}

// Each subject's filtered values to rows.
void LoadFiltered(const BatchGroup& group, std::size_t num_rows, float* rows) {
  const float* values[kLanes];
  for (std::size_t i = 0; i < kLanes; ++i) values[i] = group.contexts[i]->value.data();
  for (std::size_t i = 0; i < num_rows; i += 4) {
    const Columns columns = LoadColumns(values, i);
    float* const row = rows + i * kLanes;
    StoreLanes(columns.c0, row);
    StoreLanes(columns.c1, row + kLanes);
    StoreLanes(columns.c2, row + 2 * kLanes);
    StoreLanes(columns.c3, row + 3 * kLanes);
  }
}

// WrinkleWeightsJob.
void EvaluateWeights(const BatchGroup& group, const float* values, float* modulated) {
  const WeightTable& table = group.binding->weights;
  const std::size_t count = table.names().size();
  for (std::size_t i = 0; i < count; ++i) {
    StoreLanes(ModulatedWeight(table, static_cast<int>(i), values), modulated + i * kLanes);
  }
  const auto congruent = [&](std::size_t i) HWY_ATTR {
    return i < count ? CongruentWeight(table, i, modulated) : hn::Zero(Floats());
  };
  for (std::size_t i = 0; i < count; i += 4) {
    const Columns columns{congruent(i), congruent(i + 1), congruent(i + 2), congruent(i + 3)};
    StoreColumns(columns, group.weights.data(), i);
  }
}

void FinishRows(const BatchGroup& group, float* scratch) {
  const std::size_t num_rows = NumValueRows(*group.binding);
  StoreValues(group, num_rows, scratch);
  for (std::size_t i = 0; i < group.count; ++i) {
    EvaluateOneByOne(group, i);
    FilterSubject(group, i);
  }
  LoadFiltered(group, num_rows, scratch);
  EvaluateWeights(group, scratch, scratch + num_rows * kLanes);
}

bool AllFiniteLanes(std::span<const float> values) {
  const Floats d;
  const Float zero = hn::Zero(d);
  Float even = zero;
  Float odd = zero;
  std::size_t i = 0;
  for (; i + 2 * kLanes <= values.size(); i += 2 * kLanes) {
    even = hn::MulAdd(hn::LoadU(d, values.data() + i), zero, even);
    odd = hn::MulAdd(hn::LoadU(d, values.data() + i + kLanes), zero, odd);
  }
  const Float sum = hn::Add(even, odd);
  return hn::AllTrue(d, hn::Eq(sum, zero)) && AllFinite(values.subspan(i));
}

std::size_t NumLanes() { return kLanes; }

}  // namespace furrow::wrinkle::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace furrow::wrinkle {

HWY_EXPORT(EvaluateRows);
HWY_EXPORT(FinishRows);
HWY_EXPORT(AllFiniteLanes);
HWY_EXPORT(NumLanes);

std::size_t BatchLanes() { return HWY_DYNAMIC_DISPATCH(NumLanes)(); }

std::size_t BatchScratchSize(const BindingData& binding) {
  return (WholeVectors(static_cast<std::size_t>(binding.first_values.back())) +
          binding.weights.names().size()) *
         kMaxBatchLanes;
}

bool BatchAllFinite(std::span<const float> values) {
  return HWY_DYNAMIC_DISPATCH(AllFiniteLanes)(values);
}

unsigned EvaluateGroup(const BatchGroup& group, float* scratch) {
  return HWY_DYNAMIC_DISPATCH(EvaluateRows)(group, scratch);
}

void FinishGroup(const BatchGroup& group, float* scratch) {
  HWY_DYNAMIC_DISPATCH(FinishRows)(group, scratch);
}

void EvaluateOneByOne(const BatchGroup& group, std::size_t subject) {
  const BindingData& data = *group.binding;
  const auto num_joints = static_cast<std::size_t>(data.skeleton.num_joints());
  const std::span<const Transform> local(group.poses[subject], num_joints);
  const std::span<float> values(group.raw_values[subject], group.num_values);
  for (const int entry : data.pose_drivers.nnls_entries()) {
    if (!Reaches(values, data.pose_drivers.first_value(entry))) break;
    data.pose_drivers.EvaluateEntry(entry, local, data.chains, values);
  }
  data.strain_drivers.Evaluate(local, data.chains, values);
}

}  // namespace furrow::wrinkle
#endif  // HWY_ONCE

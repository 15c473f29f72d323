// SPDX-License-Identifier: Apache-2.0
// The group solver, compiled once for each instruction set and chosen at run time: Highway includes
// this file again and again. SSSE3 is left out (every processor with it but a few has SSE4 or
// AVX2), and so are vectors without a fixed size (SVE, RVV), which no struct can hold.
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

// `columns` as a list for each subject, as StoreColumns() does, where fewer than four are left.
inline void StoreLastColumns(const Columns& columns, float* const* subjects, std::size_t offset,
                             std::size_t count) {
  HWY_ALIGN float numbers[4][kLanes];
  for (std::size_t r = 0; r < 4; ++r) StoreLanes(columns.column[r], numbers[r]);
  for (std::size_t subject = 0; subject < kLanes; ++subject) {
    for (std::size_t r = 0; r < count; ++r) subjects[subject][offset + r] = numbers[r][subject];
  }
}

inline Columns LoadRows(const float* rows, std::size_t first, std::size_t count) {
  Columns columns;
  for (std::size_t r = 0; r < 4; ++r) {
    columns.column[r] = r < count ? LoadLanes(rows + (first + r) * kLanes) : hn::Zero(Floats());
  }
  return columns;
}

// The values of all drivers but nnls and strain, in rows.
void EvaluateRows(const BatchGroup& group, float* rows) {
  const BindingData& data = *group.binding;
  const float* const* poses = group.joints.data();
  const auto reaches = [&](int first_value) {
    return static_cast<std::size_t>(first_value) < group.num_values;
  };
  const auto row = [&](int first_value) {
    return rows + static_cast<std::size_t>(first_value) * kLanes;
  };
  std::fill(rows, row(data.first_values.back()), 0.0f);
  const auto pose_entries = data.pose_drivers.entries();
  for (std::size_t i = 0; i < pose_entries.size() && reaches(pose_entries[i].first_value); ++i) {
    if (pose_entries[i].solve == PoseSolve::kNnls) continue;
    EvaluatePose(data.pose_drivers, static_cast<int>(i), data.chains, poses,
                 row(pose_entries[i].first_value));
  }
  for (const HingeDriverSet::Entry& entry : data.hinge_drivers.entries()) {
    if (!reaches(entry.first_value)) break;
    EvaluateHinge(entry, data.chains, poses, row(entry.first_value));
  }
  for (const BallDriverSet::Entry& entry : data.ball_drivers.entries()) {
    if (!reaches(entry.first_value)) break;
    EvaluateBall(entry, data.chains, poses, row(entry.first_value));
  }
  for (const TwistDriverSet::Entry& entry : data.twist_drivers.entries()) {
    if (!reaches(entry.first_value)) break;
    EvaluateTwist(entry, data.twist_drivers.joints(entry), poses, row(entry.first_value));
  }
  for (const BlendShapeDriverSet::Entry& entry : data.blend_shape_drivers.entries()) {
    if (!reaches(entry.first_value)) break;
    EvaluateBlendShape(entry, group.blend_shapes.data(), row(entry.first_value));
  }
}

// Rows to each subject's own list.
void StoreValues(const BatchGroup& group, std::size_t count, const float* rows) {
  std::size_t i = 0;
  for (; i + 4 <= count; i += 4) {
    StoreColumns(LoadRows(rows, i, 4), group.raw_values.data(), i);
  }
  if (i < count) {
    StoreLastColumns(LoadRows(rows, i, count - i), group.raw_values.data(), i, count - i);
  }
}

// Each subject's filtered values to rows.
void LoadFiltered(const BatchGroup& group, std::size_t count, float* rows) {
  const float* values[kLanes];
  for (std::size_t i = 0; i < kLanes; ++i) values[i] = group.contexts[i]->value.data();
  std::size_t i = 0;
  for (; i + 4 <= count; i += 4) {
    const Columns columns = LoadColumns(values, i);
    for (std::size_t r = 0; r < 4; ++r) StoreLanes(columns.column[r], rows + (i + r) * kLanes);
  }
  for (; i < count; ++i) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) rows[i * kLanes + lane] = values[lane][i];
  }
}

// WrinkleWeightsJob.
void EvaluateWeights(const BatchGroup& group, const float* values, float* modulated) {
  const WeightTable& table = group.binding->weights;
  const std::size_t count = table.names().size();
  for (std::size_t i = 0; i < count; ++i) {
    StoreLanes(ModulatedWeight(table, static_cast<int>(i), values), modulated + i * kLanes);
  }
  for (std::size_t i = 0; i < count; i += 4) {
    const std::size_t now = std::min<std::size_t>(4, count - i);
    Columns columns;
    for (std::size_t r = 0; r < 4; ++r) {
      columns.column[r] = r < now ? CongruentWeight(table, i + r, modulated) : hn::Zero(Floats());
    }
    if (now == 4) {
      StoreColumns(columns, group.weights.data(), i);
    } else {
      StoreLastColumns(columns, group.weights.data(), i, now);
    }
  }
}

void SolveGroupLanes(const BatchGroup& group, float* scratch) {
  const BindingData& data = *group.binding;
  const auto count = static_cast<std::size_t>(data.first_values.back());
  EvaluateRows(group, scratch);
  StoreValues(group, count, scratch);
  for (std::size_t i = 0; i < group.count; ++i) {
    EvaluateOneByOne(group, i);
    FilterSubject(group, i);
  }
  LoadFiltered(group, count, scratch);
  EvaluateWeights(group, scratch, scratch + count * kLanes);
}

bool AllFiniteLanes(std::span<const float> values) {
  const Floats d;
  const Float zero = hn::Zero(d);
  Float sums[4] = {zero, zero, zero, zero};
  std::size_t i = 0;
  for (; i + 4 * kLanes <= values.size(); i += 4 * kLanes) {
    for (std::size_t k = 0; k < 4; ++k) {
      sums[k] = hn::MulAdd(hn::LoadU(d, values.data() + i + k * kLanes), zero, sums[k]);
    }
  }
  const Float sum = hn::Add(hn::Add(sums[0], sums[1]), hn::Add(sums[2], sums[3]));
  return hn::AllTrue(d, hn::Eq(sum, zero)) && AllFinite(values.subspan(i));
}

std::size_t NumLanes() { return kLanes; }

}  // namespace furrow::wrinkle::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace furrow::wrinkle {

HWY_EXPORT(SolveGroupLanes);
HWY_EXPORT(AllFiniteLanes);
HWY_EXPORT(NumLanes);

std::size_t BatchLanes() { return HWY_DYNAMIC_DISPATCH(NumLanes)(); }

std::size_t BatchScratchSize(const BindingData& binding) {
  const auto num_values = static_cast<std::size_t>(binding.first_values.back());
  return (num_values + binding.weights.names().size()) * kMaxBatchLanes;
}

bool BatchAllFinite(std::span<const float> values) {
  return HWY_DYNAMIC_DISPATCH(AllFiniteLanes)(values);
}

void SolveGroup(const BatchGroup& group, float* scratch) {
  HWY_DYNAMIC_DISPATCH(SolveGroupLanes)(group, scratch);
}

// For drivers whose formulas branch: nnls and strain.
void EvaluateOneByOne(const BatchGroup& group, std::size_t subject) {
  const BindingData& data = *group.binding;
  const auto num_joints = static_cast<std::size_t>(data.skeleton.num_joints());
  const std::span<const Transform> local(group.poses[subject], num_joints);
  const std::span<float> values(group.raw_values[subject], group.num_values);
  const auto entries = data.pose_drivers.entries();
  for (std::size_t i = 0; i < entries.size() && Reaches(values, entries[i].first_value); ++i) {
    if (entries[i].solve != PoseSolve::kNnls) continue;
    data.pose_drivers.EvaluateEntry(static_cast<int>(i), local, data.chains, values);
  }
  data.strain_drivers.Evaluate(local, data.chains, values);
}

}  // namespace furrow::wrinkle
#endif  // HWY_ONCE

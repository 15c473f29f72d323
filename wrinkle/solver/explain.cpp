// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/solver/explain.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>

#include "wrinkle/solver/subject_kernel.h"
#include "wrinkle/solver/subject_solver.h"

namespace furrow::wrinkle {
namespace {

// The numbers of all weights, step by step.
struct Steps {
  std::span<const float> driver_values;
  RowList combined;
  RowList modulated;
  std::span<const float> results;
};

// The weights after the plan's first half. An extra row because plans count one (num_rows()).
RowList ModulatedWeights(const WeightPlan& plan, const RowList& values) {
  RowList modulated(plan.num_rows() * kRowLanes, 0.0f);
  BestSubjectKernel().modulate_all(plan, values.data(), modulated.data());
  return modulated;
}

// The same plan with linear modulation, which leaves the combined values.
WeightPlan WithoutModulation(WeightPlan plan) {
  for (WeightBlock& block : plan.blocks) {
    block.modulation = {};
    for (std::size_t lane = 0; lane < kRowLanes; ++lane) {
      block.modulation.Set({.modulation = Modulation::kLinear, .curve = {}}, lane);
    }
  }
  return plan;
}

// What a source adds to its weight, before the gain.
float ModulatedSource(const WeightTable& table, int weight, float value) {
  if (table.combine(weight) != Combine::kSumModulated) return value;
  ModulationRow modulation;
  FloatRow row;
  for (std::size_t lane = 0; lane < kRowLanes; ++lane) {
    modulation.Set(table.modulation(weight), lane);
    row.at[lane] = value;
  }
  BestSubjectKernel().modulate(modulation, row.at);
  return row.at[0];
}

Explanation::Weight ExplainWeight(const BindingData& data, int weight, const Steps& steps) {
  const WeightTable& table = data.weights;
  const auto index = static_cast<std::size_t>(weight);
  Explanation::Weight result;
  result.name = table.names()[index];
  for (const WeightSource& source : table.sources(weight)) {
    const auto from = static_cast<std::size_t>(source.driver_value);
    const float value = steps.driver_values[from];
    const float modulated = ModulatedSource(table, weight, value);
    result.contributions.push_back({.driver_value = data.driver_value_names[from],
                                    .value = value,
                                    .gain = source.gain,
                                    .modulated = modulated,
                                    .product = source.gain * modulated});
  }
  result.combined = steps.combined[index];
  result.modulated = steps.modulated[index];
  result.modulation = ModulationName(table.modulation(weight));
  for (const std::uint16_t opponent : table.opponents(weight)) {
    const float other = steps.modulated[opponent];
    result.conflicts.push_back({.weight = table.names()[opponent],
                                .other = other,
                                .factor = BestSubjectKernel().congruence(result.modulated, other)});
  }
  result.result = steps.results[index];
  return result;
}

}  // namespace

JobStatus Explain(const RigBinding& binding, const LocalPose& pose, Explanation* explanation) {
  const BindingData& data = binding.data();
  // The binding outlives this call, so the pointer need not own it.
  // Unfiltered, so that one pose explains itself without a history.
  SubjectSolver solver(std::shared_ptr<const RigBinding>(std::shared_ptr<void>(), &binding), false);
  if (const JobStatus status = solver.Update(pose, 0.0); status != JobStatus::kOk) return status;
  // The kernel reads whole rows, the accessor is cut to size.
  const std::span<const float> values = solver.driver_values();
  RowList rows(NumRows(values.size()) * kRowLanes, 0.0f);
  std::ranges::copy(values, rows.begin());
  const Steps steps{.driver_values = values,
                    .combined = ModulatedWeights(WithoutModulation(data.weight_plan), rows),
                    .modulated = ModulatedWeights(data.weight_plan, rows),
                    .results = solver.wrinkle_weights()};
  Explanation result;
  for (std::size_t i = 0; i < data.weights.names().size(); ++i) {
    result.weights.push_back(ExplainWeight(data, static_cast<int>(i), steps));
  }
  const SolvedPose solved{.local = pose.joints,
                          .blend_shapes = pose.blend_shapes,
                          .chains = data.chains,
                          .driver_values = values,
                          .driver_value_names = data.driver_value_names};
  VisitDriverSets(data.drivers, [&](const auto& drivers) { drivers.Explain(solved, &result); });
  *explanation = std::move(result);
  return JobStatus::kOk;
}

}  // namespace furrow::wrinkle

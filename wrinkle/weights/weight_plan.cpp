// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/weights/weight_plan.h"

#include <algorithm>
#include <span>

namespace furrow::wrinkle {
namespace {

constexpr std::int32_t kYes = -1;

// The factor for the sum over `sources`.
float SumScale(Combine combine, std::span<const WeightSource> sources) {
  if (combine != Combine::kMean) return 1.0f;
  float gains = 0.0f;
  for (const WeightSource& source : sources) gains += source.gain;
  return gains > 0.0f ? 1.0f / gains : 0.0f;
}

// True if the weight is simply the largest of its driver values.
bool IsLargestValue(const WeightTable& table, int weight) {
  const auto has_gain = [](const WeightSource& source) { return source.gain != 1.0f; };
  const auto sources = table.sources(weight);
  return table.combine(weight) == Combine::kMax && !sources.empty() &&
         std::ranges::none_of(sources, has_gain);
}

// Plans the weights in their order, sixteen at a time.
class WeightPlanner {
 public:
  explicit WeightPlanner(const WeightTable& table)
      : table_(table), count_(static_cast<int>(table.names().size())) {}

  WeightPlan Plan() && {
    constexpr int kLanes = static_cast<int>(kRowLanes);
    for (first_ = 0; first_ < count_; first_ += kLanes) {
      num_lanes_ = std::min(kLanes, count_ - first_);
      WeightBlock& block = plan_.blocks.emplace_back();
      SetKinds(&block);
      AddSources(&block);
      AddOpponents(&block);
    }
    plan_.sources = RowGather(sources_, 0);
    plan_.opponents = RowGather(opponents_, 0);
    return std::move(plan_);
  }

 private:
  void SetKinds(WeightBlock* block);
  void AddSources(WeightBlock* block);
  void AddOpponents(WeightBlock* block);

  const WeightTable& table_;
  const int count_;
  int first_ = 0;  // of the block's weights
  int num_lanes_ = 0;
  WeightPlan plan_;
  std::vector<std::uint32_t> sources_;
  std::vector<std::uint32_t> opponents_;
};

void WeightPlanner::SetKinds(WeightBlock* block) {
  for (int lane = 0; lane < num_lanes_; ++lane) {
    const int weight = first_ + lane;
    const Combine combine = table_.combine(weight);
    block->scale.at[lane] = SumScale(combine, table_.sources(weight));
    if (combine == Combine::kMax) block->is_max.at[lane] = kYes;
    if (combine == Combine::kSumModulated) {
      block->is_sum_modulated.at[lane] = kYes;
      block->any_sum_modulated = true;
    }
    block->all_max = block->all_max && combine == Combine::kMax;
    block->takes_largest = block->takes_largest && IsLargestValue(table_, weight);
    block->modulation.Set(table_.modulation(weight), static_cast<std::size_t>(lane));
  }
}

void WeightPlanner::AddSources(WeightBlock* block) {
  block->first_source = static_cast<std::uint32_t>(plan_.gains.size());
  for (int lane = 0; lane < num_lanes_; ++lane) {
    const std::size_t count = table_.sources(first_ + lane).size();
    block->num_sources = std::max(block->num_sources, static_cast<std::uint32_t>(count));
  }
  for (std::size_t i = 0; i < block->num_sources; ++i) {
    FloatRow& gains = plan_.gains.emplace_back();
    // Source i of every weight of the block. Places of weights without sources, and of unused
    // lanes, are 0 with a gain of 0.
    std::vector<std::uint32_t> row(kRowLanes, 0);
    for (int lane = 0; lane < num_lanes_; ++lane) {
      const auto sources = table_.sources(first_ + lane);
      if (sources.empty()) continue;
      // Past the last source the first source's value is repeated, which loads no further row.
      const WeightSource& source = sources[i < sources.size() ? i : 0];
      row[static_cast<std::size_t>(lane)] = static_cast<std::uint32_t>(source.driver_value);
      gains.at[lane] = i < sources.size() ? source.gain : 0.0f;
    }
    sources_.insert(sources_.end(), row.begin(), row.end());
  }
}

void WeightPlanner::AddOpponents(WeightBlock* block) {
  // The first number of the row of zeros that EvaluateWeights() appends.
  const auto none =
      static_cast<std::uint32_t>(NumRows(static_cast<std::size_t>(count_)) * kRowLanes);
  block->first_opponent = static_cast<std::uint32_t>(opponents_.size() / kRowLanes);
  for (int lane = 0; lane < num_lanes_; ++lane) {
    const std::size_t count = table_.opponents(first_ + lane).size();
    block->num_opponents = std::max(block->num_opponents, static_cast<std::uint32_t>(count));
  }
  for (std::size_t i = 0; i < block->num_opponents; ++i) {
    std::vector<std::uint32_t> row(kRowLanes, none);
    for (int lane = 0; lane < num_lanes_; ++lane) {
      const auto opponents = table_.opponents(first_ + lane);
      if (i < opponents.size()) row[static_cast<std::size_t>(lane)] = opponents[i];
    }
    opponents_.insert(opponents_.end(), row.begin(), row.end());
  }
}

}  // namespace

WeightPlan MakeWeightPlan(const WeightTable& table) { return WeightPlanner(table).Plan(); }

}  // namespace furrow::wrinkle

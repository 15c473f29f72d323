// SPDX-License-Identifier: Apache-2.0
#include "client/load/measure/expected_weights.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace furrow::load {
namespace {

// Enough rounds for the filter to settle, and one more that stands for all later rounds.
std::size_t RowsKept(const Plan& plan) {
  std::uint32_t longest = 0;
  for (int i = 0; i < plan.num_subjects(); ++i)
    longest = std::max(longest, plan.count(static_cast<std::uint32_t>(i)));
  const auto frames = static_cast<std::uint32_t>(plan.num_frames());
  const std::int64_t round_us = std::max<std::int64_t>(plan.CaptureUs(0, frames), 1);
  const auto rounds = static_cast<std::size_t>(kFilterMemoryUs / round_us) + 2;
  return std::min<std::size_t>(longest, rounds * frames);
}

}  // namespace

float Distance(std::span<const float> a, std::span<const float> b) {
  if (a.size() != b.size()) return std::numeric_limits<float>::infinity();
  float largest = 0.0f;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

bool IsNear(std::span<const float> a, std::span<const float> b, float tolerance) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    // Written so that NaN is a difference.
    if (!(std::abs(a[i] - b[i]) <= tolerance)) return false;
  }
  return true;
}

ExpectedWeights::ExpectedWeights(const Workload& workload, const Plan& plan,
                                 const std::function<bool(double)>& progress)
    : frames_(static_cast<std::size_t>(plan.num_frames())),
      rows_(RowsKept(plan)),
      width_(workload.binding->weight_names().size()) {
  const auto phases = static_cast<std::size_t>(plan.num_phases());
  values_.resize(phases * rows_ * width_);
  wrinkle::LocalPose pose;
  auto out = values_.begin();
  for (int phase = 0; phase < plan.num_phases(); ++phase) {
    wrinkle::SubjectSolver solver(workload.binding);
    for (std::uint32_t i = 0; i < rows_; ++i) {
      workload.pose(plan.Frame(phase, i), &pose);
      const std::int64_t step =
          i == 0 ? 0 : plan.CaptureUs(phase, i) - plan.CaptureUs(phase, i - 1);
      (void)solver.Update(pose,
                          static_cast<double>(step) * 1e-6);  // the reader validated the poses
      out = std::ranges::copy(solver.wrinkle_weights(), out).out;
    }
    interrupted_ = !progress((phase + 1.0) / static_cast<double>(phases));
    if (interrupted_) return;
  }
}

std::span<const float> ExpectedWeights::Row(int phase, std::uint32_t pose) const {
  std::size_t row = pose;
  // Later rounds repeat the last one that is kept.
  if (row >= rows_) row = rows_ - frames_ + (pose - rows_) % frames_;
  return std::span(values_).subspan((static_cast<std::size_t>(phase) * rows_ + row) * width_,
                                    width_);
}

std::optional<ExpectedWeights::Place> ExpectedWeights::Find(std::span<const float> values,
                                                            float tolerance) const {
  if (values.size() != width_ || width_ == 0) return std::nullopt;
  const std::size_t phases = values_.size() / (rows_ * width_);
  for (std::size_t phase = 0; phase < phases; ++phase) {
    for (std::uint32_t row = 0; row < rows_; ++row) {
      const Place place{static_cast<int>(phase), row};
      if (IsNear(Row(place.phase, row), values, tolerance)) return place;
    }
  }
  return std::nullopt;
}

}  // namespace furrow::load

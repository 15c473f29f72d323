// SPDX-License-Identifier: Apache-2.0
#include "client/load/measure/replay.h"

#include <algorithm>
#include <limits>

namespace furrow::load {
namespace {

// More possibilities than this are not followed up at once.
constexpr std::size_t kMaxBranches = 16;
// A server that hears nothing for so long may have begun to hold and decay (furrowd: 0.5 s).
constexpr std::int64_t kDecayUs = 400'000;
// And so long after it the filter has forgotten.
constexpr std::int64_t kForgottenUs = 2'000'000;
// Branches as near as this are the same.
constexpr float kSame = 1e-6f;

}  // namespace

Replay::Replay(const Performance& performance, const Plan& plan, std::uint32_t subject,
               const Expected& expected, float tolerance, std::uint32_t first)
    : performance_(performance),
      plan_(plan),
      expected_(expected),
      phase_(plan.phase_of(subject)),
      tolerance_(tolerance),
      last_seen_us_(plan.CaptureUs(phase_, first)) {
  branches_.push_back({wrinkle::SubjectSolver(performance.binding), -1});
}

void Replay::Use(Branch& branch, std::uint32_t pose) {
  const std::int64_t now = plan_.CaptureUs(phase_, pose);
  const std::int64_t step = branch.last_us < 0 ? 0 : now - branch.last_us;
  branch.last_us = now;
  performance_.pose(plan_.Frame(phase_, pose), &pose_);
  (void)branch.solver.Update(pose_, static_cast<double>(step) * 1e-6);
}

// The last branch is the one in which all poses were used; it is followed through any gap.
void Replay::Missing(std::uint32_t pose) {
  const std::size_t before = branches_.size();
  if (2 * before > kMaxBranches) {
    overflowed_ = true;
    return Use(branches_.back(), pose);
  }
  for (std::size_t i = 0; i < before; ++i) {
    branches_.push_back(branches_[i]);
    Use(branches_.back(), pose);
  }
}

float Replay::Agreed(std::uint32_t pose) { return Observe(pose, expected_.Row(phase_, pose)); }

std::optional<float> Replay::Disputed(std::uint32_t pose, std::span<const float> values) {
  const float difference = Observe(pose, values);
  if (plan_.CaptureUs(phase_, pose) < unsettled_until_us_) return std::nullopt;
  return difference;
}

float Replay::Observe(std::uint32_t pose, std::span<const float> values) {
  const std::int64_t now = plan_.CaptureUs(phase_, pose);
  if (now - last_seen_us_ > kDecayUs) unsettled_until_us_ = now + kForgottenUs;
  last_seen_us_ = now;
  float nearest = std::numeric_limits<float>::infinity();
  std::vector<float> distances;
  for (Branch& branch : branches_) {
    Use(branch, pose);
    distances.push_back(Distance(branch.solver.wrinkle_weights(), values));
    nearest = std::min(nearest, distances.back());
  }
  if (nearest > tolerance_ && overflowed_) unsettled_until_us_ = now + kForgottenUs;
  if (nearest <= tolerance_) {
    overflowed_ = false;
    std::size_t i = 0;
    std::erase_if(branches_, [&](const Branch&) { return distances[i++] > tolerance_; });
  }
  Prune();
  return nearest;
}

void Replay::Prune() {
  for (std::size_t i = 0; i < branches_.size(); ++i) {
    const auto same = [&](const Branch& other) {
      return &other != &branches_[i] && other.last_us == branches_[i].last_us &&
             Distance(other.solver.filtered_values(), branches_[i].solver.filtered_values()) <=
                 kSame;
    };
    const auto after = branches_.begin() + static_cast<std::ptrdiff_t>(i) + 1;
    branches_.erase(std::remove_if(after, branches_.end(), same), branches_.end());
  }
}

}  // namespace furrow::load

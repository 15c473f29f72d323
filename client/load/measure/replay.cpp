// SPDX-License-Identifier: Apache-2.0
#include "client/load/measure/replay.h"

#include <algorithm>
#include <limits>

namespace furrow::load {
namespace {

// Largest number of possibilities that are followed at the same time. On a network that loses a
// third of the weights, one gap in 60,000 has more poses in a row than this allows for.
constexpr std::size_t kMaxBranches = 1024;
// After this time without poses a server may hold and decay the weights (furrowd: after 0.5 s).
constexpr std::int64_t kDecayUs = 400'000;
// Branches that differ by at most this are merged.
constexpr float kSame = 1e-6f;

}  // namespace

Replay::Replay(const Workload& workload, const Plan& plan, std::uint32_t subject,
               const ExpectedWeights& expected, float tolerance, std::uint32_t first)
    : workload_(workload),
      plan_(plan),
      expected_(expected),
      subject_(subject),
      phase_(plan.phase_of(subject)),
      tolerance_(tolerance),
      last_seen_us_(plan.CaptureUs(phase_, first)) {
  branches_.push_back({wrinkle::SubjectSolver(workload.binding)});
}

// The branch's server solves this pose. Its time step runs from the last pose that reached it.
void Replay::Use(Branch& branch, std::uint32_t pose) {
  const std::int64_t now = plan_.CaptureUs(phase_, pose) + plan_.ClockOffsetUs(subject_, pose);
  // As furrowd does when time goes back.
  if (branch.last_us && now < *branch.last_us) {
    branch.solver.Reset();
    branch.last_us.reset();
  }
  const std::int64_t step = now - branch.last_us.value_or(now);
  branch.last_us = now;
  workload_.pose(plan_.Frame(phase_, pose), &pose_);
  (void)branch.solver.Update(pose_, static_cast<double>(step) * 1e-6);
}

// Doubles the branches: without this pose, and with it. The last branch is the one that received
// all poses; it is followed through gaps of any length.
void Replay::Missing(std::uint32_t pose) {
  const std::size_t before = branches_.size();
  // Each missing pose doubles the possibilities, so a long gap would need too many of them.
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

std::optional<float> Replay::Mismatched(std::uint32_t pose, std::span<const float> values) {
  const float difference = Observe(pose, values);
  if (difference <= tolerance_) return difference;
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
  // The true branch may be among those that were not followed, so this does not prove an error.
  if (nearest > tolerance_ && overflowed_) unsettled_until_us_ = now + kForgottenUs;
  // Only branches that explain what arrived stay.
  if (nearest <= tolerance_) {
    overflowed_ = false;
    std::size_t i = 0;
    std::erase_if(branches_, [&](const Branch&) { return distances[i++] > tolerance_; });
  }
  Prune();
  return nearest;
}

// Branches with equal filters and times will stay equal, so one of them is enough.
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

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/wrinkle/oracle/oracle_solver.h"
#include "wrinkle/solver/batch_solver.h"

namespace furrow::wrinkle {

inline bool SameBits(std::span<const float> a, std::span<const float> b) {
  if (a.size() != b.size()) return false;
  return a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
}

inline bool SameBits(const SubjectSolver& a, const SubjectSolver& b) {
  return SameBits(a.driver_values(), b.driver_values()) &&
         SameBits(a.filtered_values(), b.filtered_values()) &&
         SameBits(a.wrinkle_weights(), b.wrinkle_weights());
}

// The same subjects three times: solved by the oracle, by SubjectSolver::Update(), and in batches.
// The oracle agrees within a tolerance; the other two agree to the bit.
class Crowd {
 public:
  static constexpr float kTolerance = 1e-6f;

  Crowd(std::shared_ptr<const RigBinding> binding, int count)
      : poses_(static_cast<std::size_t>(count)) {
    for (int i = 0; i < count; ++i) {
      expected_.emplace_back(binding);
      single_.emplace_back(binding);
      batched_.emplace_back(binding);
    }
    for (LocalPose& pose : poses_) pose.SetRest(binding->skeleton());
  }

  void SetLevel(std::size_t subject, std::size_t num_drivers) {
    expected_[subject].set_num_drivers(num_drivers);
    single_[subject].set_num_drivers(num_drivers);
    batched_[subject].set_num_drivers(num_drivers);
  }
  [[nodiscard]] LocalPose& pose(std::size_t subject) { return poses_[subject]; }
  [[nodiscard]] SubjectSolver& batched(std::size_t subject) { return batched_[subject]; }
  [[nodiscard]] std::size_t size() const { return poses_.size(); }

  // Solves the subject's pose by the oracle and by itself, and returns the update for the batch.
  BatchUpdate Update(std::size_t subject, double dt) {
    statuses_.push_back(expected_[subject].Update(poses_[subject], dt));
    EXPECT_EQ(single_[subject].Update(poses_[subject], dt), statuses_.back());
    return {.solver = &batched_[subject], .pose = &poses_[subject], .dt = dt};
  }
  void Decay(std::size_t subject, double dt) {
    expected_[subject].Decay(dt);
    EXPECT_EQ(single_[subject].Decay(dt), JobStatus::kOk);
    EXPECT_EQ(batched_[subject].Decay(dt), JobStatus::kOk);
  }
  void ExpectStatuses(const std::vector<BatchUpdate>& updates) {
    for (std::size_t i = 0; i < updates.size(); ++i) EXPECT_EQ(updates[i].status, statuses_[i]);
    statuses_.clear();
  }
  void ExpectEqual() const {
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      const std::string owner = "subject " + std::to_string(i) + ", ";
      const OracleSolver& expected = expected_[i];
      const SubjectSolver& batched = batched_[i];
      const auto& binding = expected.binding();
      Compare(owner + "raw ", binding.driver_value_names(), expected.driver_values(),
              batched.driver_values());
      Compare(owner + "filtered ", binding.driver_value_names(), expected.filtered_values(),
              batched.filtered_values());
      Compare(owner, binding.weight_names(), expected.wrinkle_weights(), batched.wrinkle_weights());
      EXPECT_TRUE(SameBits(single_[i], batched)) << owner << "by itself and in a batch";
    }
  }

 private:
  static void Compare(const std::string& what, std::span<const std::string> names,
                      std::span<const float> expected, std::span<const float> batched) {
    ASSERT_EQ(expected.size(), batched.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_NEAR(batched[i], expected[i], kTolerance) << what << names[i];
    }
  }

  std::vector<OracleSolver> expected_;
  std::vector<SubjectSolver> single_;
  std::vector<SubjectSolver> batched_;
  std::vector<LocalPose> poses_;
  std::vector<JobStatus> statuses_;
};

}  // namespace furrow::wrinkle

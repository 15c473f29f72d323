// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "tests/unit/wrinkle/oracle/combine.h"
#include "tests/unit/wrinkle/oracle/driver_oracle.h"
#include "tests/unit/wrinkle/oracle/filter_oracle.h"
#include "wrinkle/skeleton/finite.h"
#include "wrinkle/solver/binding_data.h"
#include "wrinkle/solver/subject_solver.h"

namespace furrow::wrinkle {

// SubjectSolver again, written plainly: driver by driver, without SIMD, the filter in double
// precision. Tests compare the solver with it.
class OracleSolver {
 public:
  explicit OracleSolver(std::shared_ptr<const RigBinding> binding)
      : binding_(std::move(binding)),
        filter_(binding_->rig().filter, binding_->driver_value_names().size()),
        driver_values_(binding_->driver_value_names().size()),
        weights_(binding_->weight_names().size()) {}

  JobStatus Update(const LocalPose& pose, double dt) {
    const auto num_joints = static_cast<std::size_t>(binding_->skeleton().num_joints());
    if (!std::isfinite(dt) || dt < 0.0) return JobStatus::kBadTime;
    if (pose.joints.size() < num_joints) return JobStatus::kSizeMismatch;
    if (!AllFinite(std::span(pose.joints).first(num_joints)) || !AllFinite(pose.blend_shapes)) {
      return JobStatus::kNonFinite;
    }
    driver_values_ = EvaluateDriversPlainly(*binding_, pose, num_drivers_);
    filter_.Update(driver_values_, dt);
    weights_ = WrinkleWeights(binding_->data().weights, filter_.values());
    return JobStatus::kOk;
  }
  void Decay(double dt) {
    filter_.Decay(dt);
    weights_ = WrinkleWeights(binding_->data().weights, filter_.values());
  }
  void set_num_drivers(std::size_t count) { num_drivers_ = count; }

  [[nodiscard]] std::span<const float> driver_values() const { return driver_values_; }
  [[nodiscard]] std::span<const float> filtered_values() const { return filter_.values(); }
  [[nodiscard]] std::span<const float> wrinkle_weights() const { return weights_; }
  [[nodiscard]] const RigBinding& binding() const { return *binding_; }

 private:
  std::shared_ptr<const RigBinding> binding_;
  FilterOracle filter_;
  std::vector<float> driver_values_;
  std::vector<float> weights_;
  std::size_t num_drivers_ = kAllDrivers;
};

}  // namespace furrow::wrinkle

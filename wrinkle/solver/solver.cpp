// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/solver/solver.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "wrinkle/rig/rig_check.h"
#include "wrinkle/skeleton/finite.h"
#include "wrinkle/solver/binding_data.h"

namespace furrow::wrinkle {

JobStatus DriverJob::Validate() const {
  if (binding == nullptr) return JobStatus::kNullPointer;
  const std::size_t num_joints = static_cast<std::size_t>(binding->skeleton().num_joints());
  if (local.size() < num_joints) return JobStatus::kSizeMismatch;
  if (driver_values.size() < binding->driver_value_names().size()) return JobStatus::kSizeMismatch;
  const bool finite = AllFinite(local.first(num_joints)) && AllFinite(blend_shapes);
  return finite ? JobStatus::kOk : JobStatus::kNonFinite;
}

JobStatus DriverJob::Run() const {
  if (const JobStatus status = Validate(); status != JobStatus::kOk) return status;
  const BindingData& data = binding->data();
  std::fill(driver_values.begin(), driver_values.end(), 0.0f);  // drivers with missing joints
  const std::span<float> values = driver_values.first(data.NumValues(num_drivers));
  data.pose_drivers.Evaluate(local, data.chains, values);
  data.hinge_drivers.Evaluate(local, data.chains, values);
  data.ball_drivers.Evaluate(local, data.chains, values);
  data.twist_drivers.Evaluate(local, values);
  data.blend_shape_drivers.Evaluate(blend_shapes, values);
  data.strain_drivers.Evaluate(local, data.chains, values);
  return JobStatus::kOk;
}

JobStatus WrinkleWeightsJob::Validate() const {
  if (binding == nullptr) return JobStatus::kNullPointer;
  if (driver_values.size() < binding->driver_value_names().size()) return JobStatus::kSizeMismatch;
  if (wrinkle_weights.size() < binding->weight_names().size()) return JobStatus::kSizeMismatch;
  return AllFinite(driver_values) ? JobStatus::kOk : JobStatus::kNonFinite;
}

JobStatus WrinkleWeightsJob::Run() const {
  if (const JobStatus status = Validate(); status != JobStatus::kOk) return status;
  const WeightTable& table = binding->data().weights;
  const int count = static_cast<int>(table.names().size());
  std::array<float, kMaxWeights> modulated;
  for (int i = 0; i < count; ++i) modulated[i] = table.Modulated(i, driver_values);
  for (int i = 0; i < count; ++i) {
    wrinkle_weights[i] = modulated[i] * table.Congruence(i, modulated);
  }
  return JobStatus::kOk;
}

JobStatus JointInfluenceJob::Validate() const {
  if (binding == nullptr) return JobStatus::kNullPointer;
  const std::size_t needed =
      static_cast<std::size_t>(binding->skeleton().num_joints()) * binding->dynamic_masks().size();
  if (driver_values.size() < binding->driver_value_names().size()) return JobStatus::kSizeMismatch;
  if (influences.size() < needed) return JobStatus::kSizeMismatch;
  return AllFinite(driver_values) ? JobStatus::kOk : JobStatus::kNonFinite;
}

JobStatus JointInfluenceJob::Run() const {
  if (const JobStatus status = Validate(); status != JobStatus::kOk) return status;
  binding->data().influences.Evaluate(driver_values, influences);
  return JobStatus::kOk;
}

SubjectSolver::SubjectSolver(std::shared_ptr<const RigBinding> binding, bool filter)
    : binding_(std::move(binding)), filter_(binding_->rig().filter) {
  filter_.enabled = filter_.enabled && filter;
  const std::size_t num_values = NumRows(binding_->driver_value_names().size()) * kRowLanes;
  filter_context_.Resize(static_cast<int>(num_values));
  raw_values_.assign(num_values, 0.0f);
  weights_.assign(NumRows(binding_->weight_names().size()) * kRowLanes, 0.0f);
}

JobStatus SubjectSolver::Update(const LocalPose& pose, double dt) {
  if (!std::isfinite(dt) || dt < 0.0) return JobStatus::kBadTime;
  const DriverJob drivers{.binding = binding_.get(),
                          .local = pose.joints,
                          .blend_shapes = pose.blend_shapes,
                          .driver_values = raw_values_,
                          .num_drivers = num_drivers_};
  if (const JobStatus status = drivers.Run(); status != JobStatus::kOk) return status;
  is_apart_ = true;
  return Finish(dt, raw_values_);
}

JobStatus SubjectSolver::Decay(double dt) { return Finish(dt, {}); }

JobStatus SubjectSolver::Finish(double dt, std::span<const float> input) {
  const FilterJob filter{.filter = &filter_,
                         .context = &filter_context_,
                         .dt = dt,
                         .input = input,
                         .output = filter_context_.value};
  if (const JobStatus status = filter.Run(); status != JobStatus::kOk) return status;
  const WrinkleWeightsJob weights{
      .binding = binding_.get(), .driver_values = filtered_values(), .wrinkle_weights = weights_};
  return weights.Run();
}

void SubjectSolver::Reset() {
  filter_context_.Reset();
  std::fill(raw_values_.begin(), raw_values_.end(), 0.0f);
  std::fill(weights_.begin(), weights_.end(), 0.0f);
}

}  // namespace furrow::wrinkle

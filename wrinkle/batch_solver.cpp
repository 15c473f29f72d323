// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/batch_solver.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "wrinkle/batch_kernel.h"

namespace furrow::wrinkle {
namespace {

const float* Numbers(std::span<const Transform> joints) { return &joints.data()->translation.x; }

JobStatus Check(const BatchUpdate& update, const BindingData& data) {
  if (!std::isfinite(update.dt) || update.dt < 0.0) return JobStatus::kBadTime;
  const auto num_joints = static_cast<std::size_t>(data.skeleton.num_joints());
  if (update.pose->joints.size() < num_joints) return JobStatus::kSizeMismatch;
  const std::size_t num_floats = num_joints * (sizeof(Transform) / sizeof(float));
  const bool finite =
      (num_floats == 0 || BatchAllFinite({Numbers(update.pose->joints), num_floats})) &&
      BatchAllFinite(update.pose->blend_shapes);
  return finite ? JobStatus::kOk : JobStatus::kNonFinite;
}

}  // namespace

// Adds checked updates lane by lane and solves whenever the lanes are full.
class BatchSolver::Grouping {
 public:
  Grouping(const BindingData& binding, std::size_t num_drivers, float* scratch)
      : num_lanes_(BatchLanes()), scratch_(scratch) {
    group_.binding = &binding;
    group_.num_values = binding.NumValues(num_drivers);
  }

  void Add(const BatchUpdate& update) {
    FilterContext* const context = &update.solver->filter_context_;
    const auto lanes_end = group_.contexts.begin() + static_cast<std::ptrdiff_t>(group_.count);
    // A subject's second pose builds on its first.
    if (std::find(group_.contexts.begin(), lanes_end, context) != lanes_end) Solve();
    Put(group_.count++, update);
    if (group_.count == num_lanes_) Solve();
  }

  void Solve() {
    if (group_.count == 0) return;
    for (std::size_t lane = group_.count; lane < num_lanes_; ++lane) Repeat(lane);
    SolveGroup(group_, scratch_);
    group_.count = 0;
  }

 private:
  void Put(std::size_t lane, const BatchUpdate& update) {
    SubjectSolver& solver = *update.solver;
    group_.poses[lane] = update.pose->joints.data();
    group_.joints[lane] = Numbers(update.pose->joints);
    group_.blend_shapes[lane] = update.pose->blend_shapes;
    group_.filters[lane] = &solver.filter_;
    group_.contexts[lane] = &solver.filter_context_;
    group_.dt[lane] = update.dt;
    group_.raw_values[lane] = solver.raw_values_.data();
    group_.weights[lane] = solver.weights_.data();
  }

  // Lane 0 once more: the same numbers go to the same place.
  void Repeat(std::size_t lane) {
    group_.joints[lane] = group_.joints[0];
    group_.blend_shapes[lane] = group_.blend_shapes[0];
    group_.contexts[lane] = group_.contexts[0];
    group_.raw_values[lane] = group_.raw_values[0];
    group_.weights[lane] = group_.weights[0];
  }

  const std::size_t num_lanes_;
  float* const scratch_;
  BatchGroup group_;
};

void BatchSolver::Run(std::span<BatchUpdate> updates) {
  waiting_.clear();
  for (BatchUpdate& update : updates) {
    const bool complete = update.solver != nullptr && update.pose != nullptr;
    update.status = complete ? JobStatus::kOk : JobStatus::kNullPointer;
    if (complete) waiting_.push_back(&update);
  }
  while (!waiting_.empty()) RunFirstKind();
}

// All that share the first one's binding and level of detail; the others go on waiting, in order.
void BatchSolver::RunFirstKind() {
  const SubjectSolver& first = *waiting_.front()->solver;
  const BindingData& data = first.binding().data();
  const std::size_t num_drivers = first.num_drivers();
  Grouping grouping(data, num_drivers, Scratch(BatchScratchSize(data)));
  std::size_t num_left = 0;
  for (BatchUpdate* const update : waiting_) {
    const SubjectSolver& solver = *update->solver;
    if (&solver.binding().data() != &data || solver.num_drivers() != num_drivers) {
      waiting_[num_left++] = update;
      continue;
    }
    update->status = Check(*update, data);
    if (update->status == JobStatus::kOk) grouping.Add(*update);
  }
  grouping.Solve();
  waiting_.resize(num_left);
}

float* BatchSolver::Scratch(std::size_t size) {
  constexpr std::size_t kSlack = kBatchAlignment / sizeof(float);
  if (scratch_.size() < size + kSlack) scratch_.resize(size + kSlack);
  const auto address = reinterpret_cast<std::uintptr_t>(scratch_.data());
  const std::size_t past = address % kBatchAlignment / sizeof(float);
  return scratch_.data() + (past == 0 ? 0 : kSlack - past);
}

}  // namespace furrow::wrinkle

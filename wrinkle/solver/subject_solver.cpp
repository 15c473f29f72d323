// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/solver/subject_solver.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "wrinkle/simd/prefetch.h"
#include "wrinkle/solver/subject_kernel.h"

namespace furrow::wrinkle {
namespace {

// Scratch memory for single poses. It holds nothing between calls, so each thread has one.
RowList& ScratchOfThread() {
  thread_local RowList scratch;
  return scratch;
}

// Never shrinks, so a thread allocates only for a binding larger than any before. New numbers are
// 0.
void Grow(std::size_t size, RowList* scratch) {
  if (scratch->size() < size) scratch->resize(size);
}

bool IsDuration(double dt) { return std::isfinite(dt) && dt >= 0.0; }

}  // namespace

SubjectSolver::SubjectSolver(std::shared_ptr<const RigBinding> binding, bool filter)
    : binding_(std::move(binding)), filter_(binding_->rig().filter) {
  filter_.enabled = filter_.enabled && filter;
  const std::size_t num_values = NumRows(binding_->driver_value_names().size()) * kRowLanes;
  filter_context_.Resize(num_values);
  raw_values_.assign(num_values, 0.0f);
  weights_.assign(NumRows(binding_->weight_names().size()) * kRowLanes, 0.0f);
  // Here rather than in the first update: Update() on this thread then does not allocate.
  Grow(ScratchSize(binding_->data()), &ScratchOfThread());
}

JobStatus SubjectSolver::Update(const LocalPose& pose, double dt) {
  return Solve(pose, dt, BestSubjectKernel(), &ScratchOfThread());
}

JobStatus SubjectSolver::Solve(const LocalPose& pose, double dt, const SubjectKernel& kernel,
                               RowList* scratch) {
  const BindingData& data = binding_->data();
  const auto num_joints = static_cast<std::size_t>(data.skeleton.num_joints());
  if (!IsDuration(dt)) return JobStatus::kBadTime;
  if (pose.joints.size() < num_joints) return JobStatus::kSizeMismatch;
  Grow(ScratchSize(data), scratch);
  const SubjectJob job{.binding = &data,
                       .num_values = data.NumValues(num_drivers_),
                       .pose = std::span(pose.joints).first(num_joints),
                       .blend_shapes = pose.blend_shapes,
                       .filter = &filter_,
                       .context = &filter_context_,
                       .dt = dt,
                       .raw_values = raw_values_.data(),
                       .is_apart = &is_apart_,
                       .weights = weights_.data()};
  return kernel.solve(job, scratch->data()) ? JobStatus::kOk : JobStatus::kNonFinite;
}

JobStatus SubjectSolver::Decay(double dt) {
  if (!IsDuration(dt)) return JobStatus::kBadTime;
  // Only the second half of the kernel: there is no pose to evaluate.
  HoldAndDecay(filter_, dt, &filter_context_);
  const BindingData& data = binding_->data();
  RowList& scratch = ScratchOfThread();
  Grow(ScratchSize(data), &scratch);
  BestSubjectKernel().weights(data.weight_plan, filter_context_.value.data(),
                              scratch.data() + data.num_value_rows * kRowLanes, weights_.data());
  return JobStatus::kOk;
}

void SubjectSolver::Reset() {
  filter_context_.Reset();
  std::fill(raw_values_.begin(), raw_values_.end(), 0.0f);
  std::fill(weights_.begin(), weights_.end(), 0.0f);
  is_apart_ = false;
}

SolverMemory SubjectSolver::Memory() const {
  SolverMemory memory;
  if (!filter_context_.started) return memory;
  const auto count = static_cast<std::ptrdiff_t>(binding_->driver_value_names().size());
  const auto copy = [count](const RowList& from) {
    return std::vector<float>(from.begin(), from.begin() + count);
  };
  memory.filtered = copy(filter_context_.value);
  memory.inputs = copy(filter_context_.raw);
  memory.speeds = copy(filter_context_.derivative);
  memory.since_input = filter_context_.since_input;
  return memory;
}

bool SubjectSolver::Remember(const SolverMemory& memory) {
  const std::size_t count = binding_->driver_value_names().size();
  if (memory.filtered.size() != count || memory.inputs.size() != count ||
      memory.speeds.size() != count || !IsDuration(memory.since_input)) {
    return false;
  }
  Reset();
  std::copy(memory.filtered.begin(), memory.filtered.end(), filter_context_.value.begin());
  std::copy(memory.inputs.begin(), memory.inputs.end(), filter_context_.raw.begin());
  std::copy(memory.speeds.begin(), memory.speeds.end(), filter_context_.derivative.begin());
  filter_context_.since_input = memory.since_input;
  filter_context_.started = true;
  return Decay(0.0) == JobStatus::kOk;  // no time passes: only the weights are computed again
}

JobStatus SubjectSolver::SetLevel(const LocalPose& pose, std::size_t num_drivers) {
  const BindingData& data = binding_->data();
  const auto first = static_cast<std::ptrdiff_t>(data.NumValues(num_drivers_));
  const auto last = static_cast<std::ptrdiff_t>(data.NumValues(num_drivers));
  num_drivers_ = num_drivers;
  FilterContext& filter = filter_context_;
  // Drivers that leave fade through the filter. After a decay there is no current pose to join
  // with.
  if (last <= first || !filter.started || filter.since_input > 0.0) return JobStatus::kOk;
  // A second subject that sees `pose` as its first pose has the unfiltered values.
  SubjectSolver newcomer(binding_);
  newcomer.num_drivers_ = num_drivers;
  if (const JobStatus status = newcomer.Update(pose, 0.0); status != JobStatus::kOk) return status;
  const auto join = [first, last](const RowList& from, RowList* to) {
    std::copy(from.begin() + first, from.begin() + last, to->begin() + first);
  };
  join(newcomer.filter_context_.value, &filter.value);
  join(newcomer.filter_context_.raw, &filter.raw);
  join(newcomer.filter_context_.derivative, &filter.derivative);
  return Update(pose, 0.0);  // no time passes: only the weights are computed again
}

void SubjectSolver::PrefetchState() const {
  for (const RowList* list :
       {&filter_context_.value, &filter_context_.raw, &filter_context_.derivative, &weights_}) {
    Prefetch<float>(*list);
  }
}

}  // namespace furrow::wrinkle

// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/solver/batch_solver.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "wrinkle/simd/batch_kernel.h"

namespace furrow::wrinkle {
namespace {

// From so many updates on, their poses and filters do not fit the cache together: those of the one
// that comes so much later are fetched.
constexpr std::size_t kPrefetchFrom = 256;
constexpr std::size_t kPrefetchAhead = 8;

template <class T>
void Prefetch(std::span<const T> list) {
  const auto* const bytes = reinterpret_cast<const std::byte*>(list.data());
  for (std::size_t i = 0; i < list.size_bytes(); i += 64) __builtin_prefetch(bytes + i, 0, 2);
}

}  // namespace

// Of what will be solved soon; what cannot be is told of when it is its turn.
void BatchSolver::Expect(const BatchUpdate& update) {
  if (update.solver == nullptr || update.pose == nullptr) return;
  const SubjectSolver& solver = *update.solver;
  Prefetch<Transform>(update.pose->joints);
  for (const RowList* list : {&solver.filter_context_.value, &solver.filter_context_.raw,
                              &solver.filter_context_.derivative, &solver.weights_}) {
    Prefetch<float>(*list);
  }
}

void BatchSolver::Run(std::span<BatchUpdate> updates) {
  SubjectSolve* const solve = BestSubjectSolve();
  const bool is_long = updates.size() >= kPrefetchFrom;
  for (std::size_t i = 0; i < updates.size(); ++i) {
    if (is_long && i + kPrefetchAhead < updates.size()) Expect(updates[i + kPrefetchAhead]);
    updates[i].status = Solve(updates[i], solve);
  }
}

JobStatus BatchSolver::Solve(const BatchUpdate& update, SubjectSolve* solve) {
  if (update.solver == nullptr || update.pose == nullptr) return JobStatus::kNullPointer;
  SubjectSolver& solver = *update.solver;
  const BindingData& data = solver.binding().data();
  const auto num_joints = static_cast<std::size_t>(data.skeleton.num_joints());
  if (!std::isfinite(update.dt) || update.dt < 0.0) return JobStatus::kBadTime;
  if (update.pose->joints.size() < num_joints) return JobStatus::kSizeMismatch;
  const std::size_t scratch_size = ScratchSize(data);
  if (scratch_.size() < scratch_size) scratch_.resize(scratch_size);
  const SubjectJob job{.binding = &data,
                       .num_values = data.NumValues(solver.num_drivers_),
                       .pose = std::span(update.pose->joints).first(num_joints),
                       .blend_shapes = update.pose->blend_shapes,
                       .filter = &solver.filter_,
                       .context = &solver.filter_context_,
                       .dt = update.dt,
                       .raw_values = solver.raw_values_.data(),
                       .is_apart = &solver.is_apart_,
                       .weights = solver.weights_.data()};
  return solve(job, scratch_.data()) ? JobStatus::kOk : JobStatus::kNonFinite;
}

JobStatus BatchSolver::SetLevel(SubjectSolver* solver, const LocalPose& pose,
                                std::size_t num_drivers) {
  const BindingData& data = solver->binding().data();
  const auto first = static_cast<std::ptrdiff_t>(data.NumValues(solver->num_drivers_));
  const auto last = static_cast<std::ptrdiff_t>(data.NumValues(num_drivers));
  solver->num_drivers_ = num_drivers;
  FilterContext& filter = solver->filter_context_;
  if (last <= first || !filter.started || filter.since_input > 0.0) return JobStatus::kOk;
  SubjectSolver newcomer(solver->binding_);  // whose first pose this is: it passes unchanged
  newcomer.num_drivers_ = num_drivers;
  BatchUpdate update{.solver = &newcomer, .pose = &pose};
  Run({&update, 1});
  if (update.status != JobStatus::kOk) return update.status;
  const auto join = [first, last](const RowList& from, RowList* to) {
    std::copy(from.begin() + first, from.begin() + last, to->begin() + first);
  };
  join(newcomer.filter_context_.value, &filter.value);
  join(newcomer.filter_context_.raw, &filter.raw);
  join(newcomer.filter_context_.derivative, &filter.derivative);
  update.solver = solver;  // no time has passed: new weights of the values as they are
  Run({&update, 1});
  return update.status;
}

}  // namespace furrow::wrinkle

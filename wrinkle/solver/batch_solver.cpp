// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/solver/batch_solver.h"

#include <cstddef>

#include "wrinkle/simd/prefetch.h"
#include "wrinkle/solver/subject_kernel.h"

namespace furrow::wrinkle {
namespace {

// The poses and filters of this many subjects no longer fit the cache together.
constexpr std::size_t kPrefetchFrom = 256;
// How many updates ahead memory is requested.
constexpr std::size_t kPrefetchAhead = 8;

}  // namespace

void BatchSolver::Prefetch(const BatchUpdate& update) {
  if (update.solver == nullptr || update.pose == nullptr) return;
  wrinkle::Prefetch<Transform>(update.pose->joints);
  update.solver->PrefetchState();
}

void BatchSolver::Run(std::span<BatchUpdate> updates) {
  const SubjectKernel& kernel = BestSubjectKernel();
  const bool is_long = updates.size() >= kPrefetchFrom;
  for (std::size_t i = 0; i < updates.size(); ++i) {
    if (is_long && i + kPrefetchAhead < updates.size()) Prefetch(updates[i + kPrefetchAhead]);
    BatchUpdate& update = updates[i];
    const bool is_complete = update.solver != nullptr && update.pose != nullptr;
    update.status = is_complete ? update.solver->Solve(*update.pose, update.dt, kernel, &scratch_)
                                : JobStatus::kNullPointer;
  }
}

}  // namespace furrow::wrinkle

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "wrinkle/skeleton/pose.h"
#include "wrinkle/solver/subject_solver.h"

namespace furrow::wrinkle {

// One subject's part of a batch: the arguments and the result of SubjectSolver::Update().
struct BatchUpdate {
  SubjectSolver* solver = nullptr;
  const LocalPose* pose = nullptr;    // of the solver's binding
  double dt = 0.0;                    // seconds of capture time since the subject's last pose
  JobStatus status = JobStatus::kOk;  // out
};

// SubjectSolver::Update() for many subjects: a batch is whatever arrived together. In long batches
// it fetches the memory of later subjects while it evaluates earlier ones.
//
// - Results are those of Update() to the bit, whatever the place in a batch.
// - State stays in each SubjectSolver: Update(), Decay() and batches may take turns. A subject may
//   appear in a batch several times; its updates happen in order.
// - Statuses are Update()'s, and kNullPointer. An update that fails changes nothing and does not
//   affect others.
// - Use one BatchSolver per thread. Allocates only for a binding larger than any before.
class BatchSolver {
 public:
  void Run(std::span<BatchUpdate> updates);
  // Requests the memory of an update that comes soon.
  static void Prefetch(const BatchUpdate& update);

 private:
  RowList scratch_;
};

}  // namespace furrow::wrinkle

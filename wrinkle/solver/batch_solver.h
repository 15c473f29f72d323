// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "wrinkle/skeleton/pose.h"
#include "wrinkle/solver/solver.h"

namespace furrow::wrinkle {

struct SubjectJob;
using SubjectSolve = bool(const SubjectJob& job, float* scratch);  // batch_kernel.h

// One subject's part of a batch: what SubjectSolver::Update() takes and returns.
struct BatchUpdate {
  SubjectSolver* solver = nullptr;
  const LocalPose* pose = nullptr;    // of the solver's binding
  double dt = 0.0;                    // seconds of capture time since the subject's last pose
  JobStatus status = JobStatus::kOk;  // out
};

// SubjectSolver::Update() for many subjects: the drivers of each are evaluated many of a kind side
// by side, by the best instructions that this processor has (Highway).
//
// - Any subjects in any order: the state stays in each SubjectSolver, so that a batch is whatever
//   arrived together, and Update(), Decay() and batches may take turns. A batch of one takes no
//   longer a subject than one of many, whose poses memory brings while others are evaluated.
// - A subject may stand in a batch more than once; its updates happen in order.
// - Statuses are Update()'s, and kNullPointer; an update that fails changes nothing and disturbs no
//   other. Values equal Update()'s to 1e-6, and weights too where gains are at most 1 (a twist that
//   is full within a few degrees magnifies what arc tangents differ by: to 1e-5); what comes out
//   for a subject does not depend on who else is in the batch.
// - Strain and nnls drivers branch too much for that: their points go side by side, the rest driver
//   by driver.
// - Not for two threads at once. Allocates where a binding is larger than any before, never else.
class BatchSolver {
 public:
  void Run(std::span<BatchUpdate> updates);

  // A level of detail while the subject lives (SubjectSolver::set_num_drivers()): drivers that join
  // do not fade in, but begin where `pose`, the one of the last update, puts them; all else stays.
  // Of a subject that gets no poses they rest until it does. Statuses: Update()'s. Allocates.
  [[nodiscard]] JobStatus SetLevel(SubjectSolver* solver, const LocalPose& pose,
                                   std::size_t num_drivers);

 private:
  static void Expect(const BatchUpdate& update);
  [[nodiscard]] JobStatus Solve(const BatchUpdate& update, SubjectSolve* solve);

  RowList scratch_;  // a subject's values on their way
};

}  // namespace furrow::wrinkle

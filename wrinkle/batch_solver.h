// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "wrinkle/pose.h"
#include "wrinkle/solver.h"

namespace furrow::wrinkle {

// One subject's part of a batch: what SubjectSolver::Update() takes and returns.
struct BatchUpdate {
  SubjectSolver* solver = nullptr;
  const LocalPose* pose = nullptr;    // of the solver's binding
  double dt = 0.0;                    // seconds of capture time since the subject's last pose
  JobStatus status = JobStatus::kOk;  // out
};

// SubjectSolver::Update() for many subjects at once: those that share a binding are evaluated side
// by side, one a SIMD lane, by the best instructions that this processor has (Highway).
//
// - Any subjects in any order: the state stays in each SubjectSolver, so that a batch is whatever
//   arrived together, and Update(), Decay() and batches may take turns. A batch of one is faster
//   than Update(), too; it is fastest where 16 or more share a binding.
// - A subject may stand in a batch more than once; its updates happen in order.
// - Statuses are Update()'s, and kNullPointer; an update that fails changes nothing and disturbs no
//   other. Values equal Update()'s to 1e-6, and weights too where gains are at most 1; what comes
//   out for a subject does not depend on who else is in the batch.
// - Strain and nnls drivers are evaluated subject by subject.
// - Not for two threads at once. Allocates where a binding or a mixture of bindings is larger than
//   any before, never else.
class BatchSolver {
 public:
  void Run(std::span<BatchUpdate> updates);

  // A level of detail while the subject lives (SubjectSolver::set_num_drivers()): drivers that join
  // do not fade in, but begin where `pose`, the one of the last update, puts them; all else stays.
  // Of a subject that gets no poses they rest until it does. Statuses: Update()'s. Allocates.
  [[nodiscard]] JobStatus SetLevel(SubjectSolver* solver, const LocalPose& pose,
                                   std::size_t num_drivers);

 private:
  class Grouping;
  static void Expect(const BatchUpdate& update);
  void RunFirstKind();
  float* Scratch(std::size_t size);

  std::vector<float> scratch_;         // a group's values and weights, lane by lane
  std::vector<BatchUpdate*> waiting_;  // those not yet evaluated
};

}  // namespace furrow::wrinkle

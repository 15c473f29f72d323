// SPDX-License-Identifier: Apache-2.0
#pragma once

// The solver's public parts in one include:
// - RigBinding: a rig bound to a skeleton.
// - SubjectSolver: one subject's poses to wrinkle weights.
// - JointInfluenceJob: driver values to the joints' part of dynamic masks.
// batch_solver.h, explain.h and driver_level.h are separate.
#include "wrinkle/solver/joint_influence_job.h"
#include "wrinkle/solver/rig_binding.h"
#include "wrinkle/solver/subject_solver.h"

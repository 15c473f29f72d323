// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "wrinkle/skeleton/pose.h"
#include "wrinkle/solver/rig_binding.h"

namespace furrow::wrinkle {

// The joints' part of the dynamic masks (4.2): how strongly each joint calls for each map of the
// regions with a skinning mask, already modulated. The vertices' part is clamp(sum over a vertex's
// influences of lambda(skin_weight) * influence, 0, 1): in shaders/, and for the processor in
// vertex_influence.h.
//
// - `influences` has num_joints * dynamic_masks().size() entries, joint-major. Does not allocate.
// - JointsInfluenced() of the driver's kind lists the joints of a driver. The largest of a joint's
//   influences on a map counts.
struct JointInfluenceJob {
  const RigBinding* binding = nullptr;
  std::span<const float> driver_values;  // SubjectSolver::filtered_values()
  std::span<float> influences;

  // kNullPointer or kSizeMismatch; kNonFinite for a driver value. Run() validates first, and writes
  // nothing on failure.
  [[nodiscard]] JobStatus Validate() const;
  [[nodiscard]] JobStatus Run() const;
};

}  // namespace furrow::wrinkle

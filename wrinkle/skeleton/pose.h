// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "wrinkle/skeleton/skeleton.h"

namespace furrow::wrinkle {

// Why a job did not run. Jobs are on the packet path: they never throw, allocate or format text.
enum class JobStatus {
  kOk = 0,
  kNullPointer,   // a pointer that must be set is null
  kSizeMismatch,  // a span is shorter than the skeleton or the rig needs
  kNonFinite,     // a NaN or infinity in the input; outputs are unchanged
  kBadTime,       // dt negative or not finite
};

// A subject's pose: one local transform per joint and one coefficient per blend shape.
struct LocalPose {
  std::vector<Transform> joints;    // num_joints, in the skeleton's order
  std::vector<float> blend_shapes;  // in the stream's order; empty if the stream has none

  // Sets the joints to the skeleton's rest pose and the coefficients to 0.
  void SetRest(const Skeleton& skeleton);
};

// Converts local transforms to model-space matrices, parents first (like ozz's job of that name).
//
// - `skeleton` is not null; `local` and `model` have at least num_joints entries.
// - Does not allocate. model[j] = model[parent] * T * R * S.
struct LocalToModelJob {
  const Skeleton* skeleton = nullptr;
  std::span<const Transform> local;
  std::span<glm::mat4> model;

  [[nodiscard]] JobStatus Validate() const;
  [[nodiscard]] JobStatus Run() const;
};

}  // namespace furrow::wrinkle

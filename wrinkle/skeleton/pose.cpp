// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/skeleton/pose.h"

#include <algorithm>

#include "wrinkle/skeleton/finite.h"

namespace furrow::wrinkle {

void LocalPose::SetRest(const Skeleton& skeleton) {
  joints.assign(skeleton.rest_pose().begin(), skeleton.rest_pose().end());
  std::fill(blend_shapes.begin(), blend_shapes.end(), 0.0f);
}

JobStatus LocalToModelJob::Validate() const {
  if (skeleton == nullptr) return JobStatus::kNullPointer;
  const std::size_t count = static_cast<std::size_t>(skeleton->num_joints());
  if (local.size() < count || model.size() < count) return JobStatus::kSizeMismatch;
  return AllFinite(local.first(count)) ? JobStatus::kOk : JobStatus::kNonFinite;
}

JobStatus LocalToModelJob::Run() const {
  if (const JobStatus status = Validate(); status != JobStatus::kOk) return status;
  const std::span<const std::int16_t> parents = skeleton->joint_parents();
  // Parents precede children, so the parent's matrix is always ready.
  for (std::size_t i = 0; i < parents.size(); ++i) {
    const glm::mat4 matrix = ToMatrix(local[i]);
    model[i] = parents[i] == kNoJoint ? matrix : model[parents[i]] * matrix;
  }
  return JobStatus::kOk;
}

}  // namespace furrow::wrinkle

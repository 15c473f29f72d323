// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/solver/joint_influence_job.h"

#include <cstddef>

#include "wrinkle/skeleton/finite.h"
#include "wrinkle/solver/subject_kernel.h"

namespace furrow::wrinkle {

JobStatus JointInfluenceJob::Validate() const {
  if (binding == nullptr) return JobStatus::kNullPointer;
  // One number per joint and mask, joint by joint.
  const std::size_t needed =
      static_cast<std::size_t>(binding->skeleton().num_joints()) * binding->dynamic_masks().size();
  if (driver_values.size() < binding->driver_value_names().size()) return JobStatus::kSizeMismatch;
  if (influences.size() < needed) return JobStatus::kSizeMismatch;
  return AllFinite(driver_values) ? JobStatus::kOk : JobStatus::kNonFinite;
}

JobStatus JointInfluenceJob::Run() const {
  if (const JobStatus status = Validate(); status != JobStatus::kOk) return status;
  binding->data().influences.Evaluate(driver_values, BestSubjectKernel().modulate, influences);
  return JobStatus::kOk;
}

}  // namespace furrow::wrinkle

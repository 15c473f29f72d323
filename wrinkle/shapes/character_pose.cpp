// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/shapes/character_pose.h"

namespace furrow::wrinkle {

JobStatus CharacterPose::Run(const Retarget& retarget, const BlendShapePose& shapes,
                             std::span<const Transform> joints,
                             std::span<const float> blend_shapes) {
  JobStatus status = retarget.Run(joints, local_);
  if (status == JobStatus::kOk) status = shapes.Run(blend_shapes, local_);
  if (status == JobStatus::kOk) status = LocalToModelJob{skeleton_, local_, model_}.Run();
  return status;
}

}  // namespace furrow::wrinkle

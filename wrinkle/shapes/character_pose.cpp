// SPDX-License-Identifier: Apache-2.0
#include "wrinkle/shapes/character_pose.h"

namespace furrow::wrinkle {

JobStatus CharacterPose::Run(const Maps& maps, std::span<const Transform> joints,
                             std::span<const float> blend_shapes) {
  JobStatus status = maps.retarget.Run(joints, local_);
  if (status == JobStatus::kOk) status = maps.joints.Run(blend_shapes, local_);
  if (status == JobStatus::kOk && maps.head_turn != nullptr) {
    status = maps.head_turn->Run(blend_shapes, local_);
  }
  if (status == JobStatus::kOk) status = LocalToModelJob{skeleton_, local_, model_}.Run();
  shapes_.resize(maps.shape_program != nullptr ? maps.shape_program->num_shapes() : 0);
  if (status == JobStatus::kOk && maps.shape_program != nullptr) {
    status = maps.shape_program->Run(blend_shapes, shapes_);
  }
  return status;
}

}  // namespace furrow::wrinkle

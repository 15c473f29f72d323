// SPDX-License-Identifier: Apache-2.0
#include "server/pipeline/snapshot.h"

namespace furrow::server {

Status Show(const Snapshot& snapshot, wrinkle::CharacterPose* pose, render::PosedSubject* shown) {
  if (pose->Run({*snapshot.retarget, *snapshot.blend_shape_pose, snapshot.shape_program.get(),
                 snapshot.head_turn.get()},
                snapshot.joints, snapshot.blend_shapes) != wrinkle::JobStatus::kOk) {
    return {StatusCode::kInvalidArgument, "the pose does not fit the character", "renderer"};
  }
  shown->model = pose->model();
  shown->shapes = pose->shapes();
  shown->binding = snapshot.binding.get();
  shown->wrinkle_weights = snapshot.wrinkle_weights;
  shown->filtered_values = snapshot.filtered_values;
  return {};
}

}  // namespace furrow::server

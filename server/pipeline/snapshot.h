// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/status.h"
#include "render/request/frame_request.h"
#include "wrinkle/shapes/blend_shape_pose.h"
#include "wrinkle/shapes/character_pose.h"
#include "wrinkle/shapes/head_turn.h"
#include "wrinkle/shapes/shape_program.h"
#include "wrinkle/skeleton/retarget.h"
#include "wrinkle/solver/solver.h"

namespace furrow::server {

// The complete state of one subject at one moment, passed from a network thread to the render
// thread. Changing data is copied; constant data is shared.
struct Snapshot {
  std::uint32_t sequence = 0;        // the pose's
  std::int64_t capture_time_us = 0;  // the pose's, on the sender's clock
  std::int64_t age_us = 0;           // > 0: time since the pose, while weights decay
  std::int64_t received_us = 0;      // arrival of the pose, on the daemon's clock
  std::shared_ptr<const wrinkle::RigBinding> binding;
  std::shared_ptr<const wrinkle::Retarget>
      retarget;  // from the stream's skeleton to the character's
  std::shared_ptr<const wrinkle::BlendShapePose> blend_shape_pose;
  std::shared_ptr<const wrinkle::ShapeProgram> shape_program;  // null: no shapes
  std::shared_ptr<const wrinkle::HeadTurn> head_turn;          // null: the head is not turned
  std::vector<wrinkle::Transform> joints;  // local transforms, stream's skeleton
  std::vector<float> blend_shapes;         // in the stream's order
  std::vector<float> wrinkle_weights;      // in the order of the binding
  std::vector<float> filtered_values;
};

// Writes the subject of a picture to `shown`, which refers to both arguments afterwards. `pose`:
// moves the character of the renderer. Error: kInvalidArgument (the pose does not fit it).
[[nodiscard]] Status Show(const Snapshot& snapshot, wrinkle::CharacterPose* pose,
                          render::PosedSubject* shown);

}  // namespace furrow::server

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "wrinkle/shapes/blend_shape_pose.h"
#include "wrinkle/skeleton/retarget.h"
#include "wrinkle/solver/solver.h"

namespace furrow::server {

// One subject at one moment, complete: what crosses from a network thread to the render thread. By
// value where it changes, shared where it never does.
struct Snapshot {
  std::uint32_t sequence = 0;        // the pose's
  std::int64_t capture_time_us = 0;  // the pose's, on its sender's clock
  std::int64_t age_us = 0;           // > 0 while weights hold and decay without a pose
  std::int64_t received_us = 0;      // when the pose came, on the daemon's clock
  std::shared_ptr<const wrinkle::RigBinding> binding;
  std::shared_ptr<const wrinkle::Retarget> retarget;  // stream's skeleton -> character's
  std::shared_ptr<const wrinkle::BlendShapePose> blend_shape_pose;
  std::vector<wrinkle::Transform> joints;  // local, of the stream's skeleton
  std::vector<float> blend_shapes;         // in the stream's order
  std::vector<float> wrinkle_weights;
  std::vector<float> filtered_values;
};

}  // namespace furrow::server

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "protocol/messages/messages.h"
#include "wrinkle/skeleton/pose.h"
#include "wrinkle/solver/solver.h"

namespace furrow::load {

// The recording that all subjects of a load test send, with what is needed to solve the same poses
// locally.
struct Workload {
  protocol::SkeletonOffer offer;                    // each subject replaces the name
  std::vector<double> times;                        // of the frames: seconds, increasing
  std::vector<std::vector<std::uint8_t>> messages;  // one whole Pose message per frame
  std::function<void(int frame, wrinkle::LocalPose* pose)>
      pose;                                            // sets `pose` to that of a message
  std::shared_ptr<const wrinkle::RigBinding> binding;  // null: do not check weights
};

}  // namespace furrow::load

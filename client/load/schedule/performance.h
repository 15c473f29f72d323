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

// A recording, ready to be sent by many subjects at once and to be solved beside the server.
struct Performance {
  protocol::SkeletonOffer offer;                    // the subject's name is replaced
  std::vector<double> times;                        // of the frames: seconds, increasing
  std::vector<std::vector<std::uint8_t>> messages;  // each frame as a whole Pose message
  std::function<void(int frame, wrinkle::LocalPose* pose)> pose;  // what its message says
  std::shared_ptr<const wrinkle::RigBinding> binding;             // null: weights are not checked
};

}  // namespace furrow::load

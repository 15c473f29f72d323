// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "server/core/time.h"
#include "wrinkle/skeleton/pose.h"

namespace furrow::server {

// Since when a subject shows the same: its pose and its wrinkle weights stayed within what no eye
// sees of where they were when they last moved, so that slow creeping counts as moving.
class RestDetector {
 public:
  void Update(const wrinkle::LocalPose& pose, std::span<const float> wrinkle_weights, Time now);
  // When it last moved; 0 before the first Update().
  [[nodiscard]] Time moved_at() const { return moved_at_; }

 private:
  std::vector<wrinkle::Transform> joints_;
  std::vector<float> values_;  // blend shapes, then weights
  Time moved_at_{0};
};

}  // namespace furrow::server

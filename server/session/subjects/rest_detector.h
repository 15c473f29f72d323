// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "server/core/time.h"
#include "wrinkle/skeleton/pose.h"

namespace furrow::server {

// Tracks when a subject last moved visibly. Poses and weights are compared with those of the last
// movement, not with the previous pose, so slow drift counts as movement.
class RestDetector {
 public:
  // Compares a new pose and its weights, which arrived at `now`, with the last movement.
  void Update(const wrinkle::LocalPose& pose, std::span<const float> wrinkle_weights, Time now);
  // Arrival time of the last pose that moved; 0 before the first Update().
  [[nodiscard]] Time moved_at() const { return moved_at_; }

 private:
  std::vector<wrinkle::Transform> joints_;
  std::vector<float> values_;  // blend shapes, then weights
  Time moved_at_{0};
};

}  // namespace furrow::server

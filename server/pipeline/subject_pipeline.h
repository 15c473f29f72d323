// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "server/pipeline/snapshot.h"
#include "server/pipeline/stream_definition.h"
#include "wrinkle/pose.h"
#include "wrinkle/solver.h"

namespace furrow::server {

// One subject's way from pose to wrinkle weights. Lives on one thread; allocates in the constructor
// (and in TakeSnapshot) alone.
class SubjectPipeline {
 public:
  explicit SubjectPipeline(std::shared_ptr<const StreamDefinition> stream);

  // The pose to fill before Solve(): joints in the skeleton's order. Joints and blend shapes that a
  // partial pose leaves out keep what they had; before the first pose they rest.
  [[nodiscard]] wrinkle::LocalPose* mutable_pose() { return &pose_; }

  [[nodiscard]] const wrinkle::LocalPose& pose() const { return pose_; }

  // Evaluates the pose. Time passes as the capture times say; one that goes back (a recording that
  // loops, a clock that was set) starts the filter anew, as for a first pose.
  [[nodiscard]] wrinkle::JobStatus Solve(std::uint32_t sequence, std::int64_t capture_time_us);

  // Nothing arrived for `dt` more seconds: hold, then decay to neutral. The pose stays as it was.
  [[nodiscard]] wrinkle::JobStatus Decay(double dt);
  // True once every weight has decayed to neutral.
  [[nodiscard]] bool neutral() const;

  [[nodiscard]] bool has_pose() const { return has_pose_; }
  [[nodiscard]] std::uint32_t sequence() const { return sequence_; }
  [[nodiscard]] std::int64_t capture_time_us() const { return capture_time_us_; }
  [[nodiscard]] std::span<const float> wrinkle_weights() const { return solver_.wrinkle_weights(); }
  [[nodiscard]] std::span<const float> driver_values() const { return solver_.driver_values(); }
  [[nodiscard]] const StreamDefinition& stream() const { return *stream_; }

  [[nodiscard]] std::shared_ptr<const Snapshot> TakeSnapshot(std::int64_t age_us) const;

 private:
  std::shared_ptr<const StreamDefinition> stream_;
  wrinkle::SubjectSolver solver_;
  wrinkle::LocalPose pose_;
  std::uint32_t sequence_ = 0;
  std::int64_t capture_time_us_ = 0;
  bool has_pose_ = false;
};

}  // namespace furrow::server

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "server/pipeline/snapshot.h"
#include "server/pipeline/stream_definition.h"
#include "wrinkle/skeleton/pose.h"
#include "wrinkle/solver/batch_solver.h"
#include "wrinkle/solver/solver.h"

namespace furrow::server {

// One subject's way from pose to wrinkle weights. Lives on one thread; allocates in the constructor
// (and in TakeSnapshot) alone.
class SubjectPipeline {
 public:
  explicit SubjectPipeline(std::shared_ptr<const StreamDefinition> stream);

  // The pose to fill before Solve(): joints in the skeleton's order. Joints and blend shapes that a
  // partial pose leaves out keep what they had; before the first pose they rest. What Solve()
  // refuses stays here all the same, until a pose that is not partial comes.
  [[nodiscard]] wrinkle::LocalPose* mutable_pose() { return &pose_; }

  [[nodiscard]] const wrinkle::LocalPose& pose() const { return pose_; }
  // What the weights are made from: the pose, measured from the neutral where there is one.
  [[nodiscard]] const wrinkle::LocalPose& solved_pose() const {
    return neutral_pose_ ? corrected_ : pose_;
  }

  // The pose that counts as rest for the weights (a performer's own neutral face); none: the
  // skeleton's. The picture shows the pose as it is. Evaluates the pose anew. False: it has not as
  // many joints and blend shapes as the stream; nothing has changed.
  bool SetNeutral(std::optional<wrinkle::LocalPose> neutral);
  [[nodiscard]] const std::optional<wrinkle::LocalPose>& neutral_pose() const {
    return neutral_pose_;
  }

  // The same stream with another rig: the pose stays, and is evaluated anew. Precondition: the
  // skeleton and the blend shapes are those it has.
  void SetStream(std::shared_ptr<const StreamDefinition> stream);

  // Evaluates the pose. Time passes as the capture times say; one that goes back (a recording that
  // loops, a clock that was set) starts the filter anew, as for a first pose.
  [[nodiscard]] wrinkle::JobStatus Solve(std::uint32_t sequence, std::int64_t capture_time_us);

  // Solve() in two halves, so that many subjects are evaluated as one batch in between. Until
  // Finish() the pose must stay, and nothing else here be called but accessors.
  [[nodiscard]] wrinkle::BatchUpdate Prepare(std::uint32_t sequence, std::int64_t capture_time_us);
  wrinkle::JobStatus Finish(wrinkle::JobStatus status);
  // Between the two.
  [[nodiscard]] bool waits() const { return waits_; }

  // From the next pose on only so many of the rig's drivers count, in its order: those that
  // somebody looks at. Drivers that join begin at the pose that is there.
  void SetLevel(std::size_t num_drivers);
  [[nodiscard]] std::size_t level() const { return solver_.num_drivers(); }

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
  [[nodiscard]] std::shared_ptr<const StreamDefinition> shared_stream() const { return stream_; }

  [[nodiscard]] std::shared_ptr<const Snapshot> TakeSnapshot(std::int64_t age_us,
                                                             std::int64_t received_us = 0) const;

 private:
  void SolveAnew();
  void MeasureFromNeutral();

  std::shared_ptr<const StreamDefinition> stream_;
  wrinkle::SubjectSolver solver_;
  wrinkle::LocalPose pose_;
  std::optional<wrinkle::LocalPose> neutral_pose_;
  wrinkle::LocalPose corrected_;  // where there is a neutral pose
  std::uint32_t sequence_ = 0;
  std::int64_t capture_time_us_ = 0;
  bool has_pose_ = false;
  // What Finish() makes of a pose that waits for its evaluation.
  std::uint32_t next_sequence_ = 0;
  std::int64_t next_capture_time_us_ = 0;
  bool waits_ = false;
};

}  // namespace furrow::server

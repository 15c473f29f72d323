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

// Turns the poses of one subject into wrinkle weights. Used by one thread at a time. Only the
// constructor, TakeSnapshot() and the setters allocate.
class SubjectPipeline {
 public:
  explicit SubjectPipeline(std::shared_ptr<const StreamDefinition> stream);

  // The pose to fill before Solve(): local joint transforms in the skeleton's order, and blend
  // shapes in the stream's order; Prepare() computes those behind them. It starts at rest and keeps
  // the last values, including those that Solve() has refused, so that partial poses can build on
  // them.
  [[nodiscard]] wrinkle::LocalPose* mutable_pose() { return &pose_; }

  [[nodiscard]] const wrinkle::LocalPose& pose() const { return pose_; }
  // The pose from which weights are solved: pose(), relative to the neutral pose if one is set.
  [[nodiscard]] const wrinkle::LocalPose& solved_pose() const {
    return neutral_pose_ ? corrected_ : pose_;
  }

  // Measures weights from `neutral` (the performer's relaxed face) instead of the skeleton's rest
  // pose; nullopt: from the rest pose. Pictures show the face relative to `neutral`, too: its
  // joints (FaceJoints()), the blend shapes, and with them the gaze and the head that a phone
  // sends. They show the body unchanged, so a performer who stands with hanging arms does so in the
  // picture.
  //
  // Relative to its neutral n, a coefficient c is c - n. In pictures, coefficients above their
  // neutral are (c - n) / (1 - n), with n at most 0.5 in the divisor, so that 1 stays 1 and lids
  // close. Angles (of head and eyes, in radians) are c - n there, too.
  //
  // Solves the current pose again. False: the counts of joints or blend shapes differ from the
  // stream's; nothing has changed.
  bool SetNeutral(std::optional<wrinkle::LocalPose> neutral);
  [[nodiscard]] const std::optional<wrinkle::LocalPose>& neutral_pose() const {
    return neutral_pose_;
  }

  // Switches to another rig and solves the current pose again. Precondition: `stream` has the same
  // skeleton and blend shapes.
  void SetStream(std::shared_ptr<const StreamDefinition> stream);

  // Solves the pose. The filter's time step is the difference of capture times. A capture time that
  // goes back (a looping recording, a clock that was set) restarts the filter.
  [[nodiscard]] wrinkle::JobStatus Solve(std::uint32_t sequence, std::int64_t capture_time_us);

  // Requests the memory that a pose uses, so that it arrives while the pose is decoded.
  void Prefetch() { wrinkle::BatchSolver::Prefetch({.solver = &solver_, .pose = &pose_}); }
  // Solve() in two parts, between which BatchSolver solves many subjects together. Between them,
  // the pose must not change and only accessors may be called.
  [[nodiscard]] wrinkle::BatchUpdate Prepare(std::uint32_t sequence, std::int64_t capture_time_us);
  wrinkle::JobStatus Finish(wrinkle::JobStatus status);
  // True between Prepare() and Finish().
  [[nodiscard]] bool waits() const { return waits_; }

  // Evaluates only the first `num_drivers` drivers of the rig from the next pose on. Drivers that
  // are added start at the current pose.
  void SetLevel(std::size_t num_drivers);
  [[nodiscard]] std::size_t level() const { return solver_.num_drivers(); }

  // What another pipeline needs to go on as if it were this one, besides the pose and the neutral
  // pose. Also before the first pose, with an empty memory.
  struct Memory {
    std::uint32_t sequence = 0;  // of the last solved pose
    std::int64_t capture_time_us = 0;
    std::size_t level = wrinkle::kAllDrivers;
    wrinkle::SolverMemory solver;
  };
  [[nodiscard]] Memory memory() const;
  // Goes on from `pose`, the last one of the other pipeline, and from its memory. Call it after
  // SetNeutral(). False, and nothing has changed: they do not fit the stream.
  bool Resume(const wrinkle::LocalPose& pose, const Memory& memory);

  // Advances the weights by `dt` seconds without a new pose: they hold, then decay to neutral. The
  // pose stays.
  [[nodiscard]] wrinkle::JobStatus Decay(double dt);
  // True if every driver value has decayed so far that it is neither visible nor sent.
  [[nodiscard]] bool neutral() const;

  // True after the first solved pose. The next two describe the last solved pose.
  [[nodiscard]] bool has_pose() const { return has_pose_; }
  [[nodiscard]] std::uint32_t sequence() const { return sequence_; }
  [[nodiscard]] std::int64_t capture_time_us() const { return capture_time_us_; }
  [[nodiscard]] std::span<const float> wrinkle_weights() const { return solver_.wrinkle_weights(); }
  [[nodiscard]] std::span<const float> driver_values() const { return solver_.driver_values(); }
  [[nodiscard]] const StreamDefinition& stream() const { return *stream_; }
  [[nodiscard]] std::shared_ptr<const StreamDefinition> shared_stream() const { return stream_; }

  // Copies the current state. `age_us`: time since the pose, > 0 while weights decay.
  // `received_us`: arrival of the pose on the daemon's clock.
  [[nodiscard]] std::shared_ptr<const Snapshot> TakeSnapshot(std::int64_t age_us,
                                                             std::int64_t received_us = 0) const;

 private:
  // Solves the last pose, and lets its values decay for `decayed` seconds.
  void SolveAgain(double decayed);
  void SubtractNeutral();
  void PrepareNeutral();
  void ShowFaceFromNeutral(Snapshot* snapshot) const;

  std::shared_ptr<const StreamDefinition> stream_;
  wrinkle::SubjectSolver solver_;
  wrinkle::LocalPose pose_;
  std::optional<wrinkle::LocalPose> neutral_pose_;
  wrinkle::LocalPose corrected_;  // pose_ relative to neutral_pose_, if there is one
  // Per blend shape with a neutral_pose_: factor of values above the neutral one in pictures.
  std::vector<float> above_neutral_;
  std::vector<bool> face_joints_;  // those that pictures show relative to neutral_pose_
  std::uint32_t sequence_ = 0;
  std::int64_t capture_time_us_ = 0;
  bool has_pose_ = false;
  // From Prepare(); Finish() makes them current.
  std::uint32_t next_sequence_ = 0;
  std::int64_t next_capture_time_us_ = 0;
  bool waits_ = false;
};

}  // namespace furrow::server

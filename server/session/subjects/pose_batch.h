// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "protocol/framing/envelope.h"
#include "server/core/time.h"
#include "server/session/subjects/subject_registry.h"
#include "wrinkle/solver/batch_solver.h"

namespace furrow::server {

// A pose that its subject has taken and that waits for its evaluation.
struct GatheredPose {
  Subject* subject = nullptr;
  protocol::Header header;
  std::span<const std::uint8_t> payload;                // as RecordingTap::OnPose() takes it
  Time now{0};                                          // of arrival
  wrinkle::JobStatus status = wrinkle::JobStatus::kOk;  // of Solve()
};

// Poses of different subjects that arrived together, to be evaluated together. Does not allocate
// in the long run.
class PoseBatch {
 public:
  static constexpr std::size_t kCapacity = 128;

  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] bool full() const { return size_ == kCapacity; }
  // Precondition: not full; the subject's pipeline does not wait. It does from here on, and with
  // the bytes of `pose.payload` stays as it is until Solve().
  void Add(const GatheredPose& pose);
  // Evaluates what was added and empties the batch: the poses, in the order in which they came.
  // Valid until the next Add().
  [[nodiscard]] std::span<const GatheredPose> Solve();

 private:
  std::size_t size_ = 0;
  std::array<GatheredPose, kCapacity> poses_;
  std::array<wrinkle::BatchUpdate, kCapacity> updates_;
  wrinkle::BatchSolver solver_;
};

}  // namespace furrow::server

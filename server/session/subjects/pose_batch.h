// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "base/time/timecode.h"
#include "protocol/framing/envelope.h"
#include "server/core/time.h"
#include "server/session/subjects/subject_registry.h"
#include "wrinkle/solver/batch_solver.h"

namespace furrow::server {

// A pose that its subject has accepted and that waits to be solved.
struct GatheredPose {
  Subject* subject = nullptr;
  protocol::Header header;
  std::optional<Timecode> timecode;
  std::span<const std::uint8_t> payload;  // the FlatBuffers payload; empty: not a whole pose
  Time now{0};                            // arrival
  wrinkle::JobStatus status = wrinkle::JobStatus::kOk;  // set by Solve()
};

// Poses of different subjects that arrived together and are solved together, which is faster than
// one by one. Does not allocate in the long run.
class PoseBatch {
 public:
  static constexpr std::size_t kCapacity = 128;

  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool full() const { return size_ == kCapacity; }
  // Preconditions: not full(), and no other pose of the subject is in the batch. The subject's
  // pipeline and the bytes of `pose.payload` must not change until Solve().
  void Add(const GatheredPose& pose);
  // Solves the poses and empties the batch. Returns the poses in the order in which they were
  // added; valid until the next Add().
  [[nodiscard]] std::span<const GatheredPose> Solve();

 private:
  std::size_t size_ = 0;
  std::array<GatheredPose, kCapacity> poses_;
  std::array<wrinkle::BatchUpdate, kCapacity> updates_;
  wrinkle::BatchSolver solver_;
};

}  // namespace furrow::server

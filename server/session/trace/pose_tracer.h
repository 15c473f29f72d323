// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "server/core/time.h"
#include "server/pipeline/picture_source.h"
#include "server/session/trace/pose_trace.h"

namespace furrow::server {

// Follows one pose through the daemon, on request. A pose that nobody asked for costs one
// comparison.
//
// The shard that publishes the subject calls On...() under its lock; everything else requires the
// hub's exclusive lock.
class PoseTracer {
 public:
  // `clock`: reads the daemon's clock.
  explicit PoseTracer(std::function<Time()> clock) : clock_(std::move(clock)) {}

  // The next pose of the subject is followed. Replaces the trace before. `subject`: its id.
  void Request(std::uint64_t subject, std::string name);
  enum class State : std::uint8_t { kNone, kWaiting, kDone };
  // kDone: trace() is complete, apart from its picture. kWaiting: its pose has not come yet.
  [[nodiscard]] State state() const { return state_; }
  [[nodiscard]] const PoseTrace& trace() const { return trace_; }
  // The first picture that shows the pose, or a later one of the subject, has reached its viewers.
  void OnPicture(const FinishedPicture& picture);

  // True if the subject's next pose is to be followed.
  [[nodiscard]] bool Wants(std::uint64_t subject) const {
    return wanted_.load(std::memory_order_relaxed) == subject;
  }
  [[nodiscard]] bool Follows(std::uint64_t subject) const { return subject_ == subject; }
  // The pose has been accepted. `trace`: what is known of it.
  void OnAccepted(const PoseTrace& trace);
  void OnSolving(std::size_t batch);
  void OnSolved() { trace_.solved = clock_(); }
  // The solver has refused the pose. The next one is followed instead.
  void OnRefused();
  void OnPublished() { trace_.published = clock_(); }
  void OnSent();

 private:
  const std::function<Time()> clock_;
  std::atomic<std::uint64_t> wanted_{0};  // the subject whose next pose is followed; 0: none
  std::uint64_t subject_ = 0;             // that of trace_
  State state_ = State::kNone;
  PoseTrace trace_;
};

}  // namespace furrow::server

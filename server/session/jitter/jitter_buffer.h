// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "server/core/capture_clock.h"
#include "server/core/time.h"
#include "server/session/jitter/held_pose.h"

namespace furrow::server {

// The poses of one stream that wait for their time, in order of their sequence numbers. A pose is
// due when `delay` has passed since it would have arrived on a network without jitter
// (CaptureClock), so poses leave at the pace of their capture, and none waits longer than `delay`.
class JitterBuffer {
 public:
  // What becomes of a pose. kLate: a newer pose has left already. kDuplicate: it waits already.
  enum class Place : std::uint8_t { kHeld, kLate, kDuplicate };

  // Decides about a pose that arrived. For kHeld, `due` receives when it leaves; pass it to Hold().
  [[nodiscard]] Place Look(const protocol::Header& header, Time delay, Time now, Time* due);
  // The same for a pose that arrived before an earlier one, for which it waits until `due`: for
  // `wait`, or as long as the poses behind it. Whether it is late is up to the caller.
  [[nodiscard]] Place LookAhead(const protocol::Header& header, Time wait, Time now, Time* due);
  // True if the pose with this sequence neither waits nor came too late.
  [[nodiscard]] bool Misses(std::uint32_t sequence) const;
  // Adds a pose that Look() would hold.
  void Hold(std::unique_ptr<HeldPose> pose);
  // Takes the oldest pose if its time has come, else returns null.
  [[nodiscard]] std::unique_ptr<HeldPose> TakeDue(Time now);
  // Takes the oldest pose if it has this sequence, else returns null.
  [[nodiscard]] std::unique_ptr<HeldPose> TakeIf(std::uint32_t sequence);
  // Takes the oldest pose. Precondition: not empty().
  [[nodiscard]] std::unique_ptr<HeldPose> TakeOldest();

  [[nodiscard]] bool empty() const { return held_.empty(); }
  [[nodiscard]] std::size_t size() const { return held_.size(); }
  // When the oldest pose leaves. Precondition: not empty().
  [[nodiscard]] Time due() const { return held_.front()->due; }
  // Of the newest pose that was taken.
  [[nodiscard]] std::uint32_t newest_left() const { return newest_left_; }
  [[nodiscard]] Time last_arrival() const { return last_arrival_; }

 private:
  CaptureClock clock_;
  std::vector<std::unique_ptr<HeldPose>> held_;  // by sequence
  bool has_left_ = false;
  std::uint32_t newest_left_ = 0;  // sequence of the newest pose that was taken
  Time last_arrival_{0};
};

}  // namespace furrow::server

// SPDX-License-Identifier: Apache-2.0
#include "server/session/jitter/jitter_buffer.h"

#include <algorithm>
#include <utility>

#include "protocol/framing/sequence.h"

namespace furrow::server {

using protocol::IsNewer;

JitterBuffer::Place JitterBuffer::Look(const protocol::Header& header, Time delay, Time now,
                                       Time* due) {
  last_arrival_ = now;
  // Late poses count for the clock, too: after the sender's clock was set, all of them are late.
  *due = clock_.Arrival(header.capture_time_us, now) + delay;
  if (has_left_ && !IsNewer(header.sequence, newest_left_)) return Place::kLate;
  return Misses(header.sequence) ? Place::kHeld : Place::kDuplicate;
}

JitterBuffer::Place JitterBuffer::LookAhead(const protocol::Header& header, Time wait, Time now,
                                            Time* due) {
  last_arrival_ = now;
  *due = now + wait;
  const auto behind = std::ranges::find_if(
      held_, [&](const auto& pose) { return IsNewer(pose->header.sequence, header.sequence); });
  if (behind != held_.end()) *due = std::min(*due, (*behind)->due);
  return Misses(header.sequence) ? Place::kHeld : Place::kDuplicate;
}

bool JitterBuffer::Misses(std::uint32_t sequence) const {
  const auto same = [=](const auto& pose) { return pose->header.sequence == sequence; };
  return (!has_left_ || IsNewer(sequence, newest_left_)) && std::ranges::none_of(held_, same);
}

void JitterBuffer::Hold(std::unique_ptr<HeldPose> pose) {
  // From the back: most poses are newer than all that wait.
  auto at = held_.end();
  while (at != held_.begin() && IsNewer((*(at - 1))->header.sequence, pose->header.sequence)) --at;
  held_.insert(at, std::move(pose));
}

std::unique_ptr<HeldPose> JitterBuffer::TakeDue(Time now) {
  return held_.empty() || held_.front()->due > now ? nullptr : TakeOldest();
}

std::unique_ptr<HeldPose> JitterBuffer::TakeIf(std::uint32_t sequence) {
  const bool is_it = !held_.empty() && held_.front()->header.sequence == sequence;
  return is_it ? TakeOldest() : nullptr;
}

std::unique_ptr<HeldPose> JitterBuffer::TakeOldest() {
  std::unique_ptr<HeldPose> oldest = std::move(held_.front());
  held_.erase(held_.begin());
  has_left_ = true;
  newest_left_ = oldest->header.sequence;
  return oldest;
}

}  // namespace furrow::server

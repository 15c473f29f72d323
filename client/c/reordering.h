// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "protocol/messages/messages.h"

namespace furrow::capi {

// Returns true if a frame is older than the newest one, or a repetition of it: datagrams overtake
// each other, by 64 frames and 200 ms at most. An older frame beyond that comes from a publisher
// that has restarted and counts from 0 again. `elapsed_us`: time since the newest frame.
[[nodiscard]] inline bool IsLate(const protocol::Header& frame, const protocol::Header& newest,
                                 std::int64_t elapsed_us) {
  constexpr std::uint32_t kMostFrames = 64;
  constexpr std::int64_t kMostUs = 200'000;
  if (elapsed_us > kMostUs || frame.capture_time_us > newest.capture_time_us) return false;
  return newest.sequence - frame.sequence <= kMostFrames;  // wraps around
}

}  // namespace furrow::capi

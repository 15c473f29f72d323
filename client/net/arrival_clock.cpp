// SPDX-License-Identifier: Apache-2.0
#include "client/net/arrival_clock.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <ctime>

#include "client/net/clock.h"

namespace furrow::net {
namespace {

// A larger change of the offset than this, plus one part in a thousand of the elapsed time, is a
// step of the wall clock. NTP slews by less.
constexpr std::int64_t kStepNs = 1'000'000;
constexpr std::int64_t kSlewShare = 1000;

std::int64_t Nanoseconds(const timespec& time) {
  return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

std::int64_t WallNanoseconds() {
  timespec time{};
  clock_gettime(CLOCK_REALTIME, &time);
  return Nanoseconds(time);
}

}  // namespace

void ArrivalClock::Enable(int socket) {
  const int on = 1;  // on failure the time of the read is used instead
  setsockopt(socket, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof(on));
}

// Reads the steady clock last: the time between the two reads makes arrivals later, never earlier.
void ArrivalClock::Read() {
  const std::int64_t wall_ns = WallNanoseconds();
  Set(SteadyNanoseconds(), wall_ns);
}

void ArrivalClock::Set(std::int64_t steady_ns, std::int64_t wall_ns) {
  // The offset of the two clocks is nearly constant. A jump means that the wall clock was set, and
  // stamps from before the jump cannot be converted.
  const std::int64_t ahead_ns = wall_ns - steady_ns;
  const std::int64_t slew_ns = kStepNs + (steady_ns - steady_ns_) / kSlewShare;
  was_set_ = ahead_ns_ && std::abs(ahead_ns - *ahead_ns_) > slew_ns;
  ahead_ns_ = ahead_ns;
  steady_ns_ = steady_ns;
  wall_ns_ = wall_ns;
}

std::int64_t ArrivalClock::FromWall(std::int64_t wall_ns) const {
  // No stamp can lie after the read, so a negative difference counts as 0.
  if (was_set_) return steady_ns_;
  return steady_ns_ - std::max<std::int64_t>(wall_ns_ - wall_ns, 0);
}

std::int64_t ArrivalClock::Arrival(msghdr* header) const {
  for (cmsghdr* item = CMSG_FIRSTHDR(header); item != nullptr; item = CMSG_NXTHDR(header, item)) {
    if (item->cmsg_level != SOL_SOCKET || item->cmsg_type != SCM_TIMESTAMPNS) continue;
    timespec stamp{};
    std::memcpy(&stamp, CMSG_DATA(item), sizeof(stamp));
    return FromWall(Nanoseconds(stamp));
  }
  return steady_ns_;
}

}  // namespace furrow::net

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>

#include "server/core/time.h"
#include "server/tls/handshake.h"

namespace furrow::server {

// How long a stranger may keep its place (HandshakePlaces) while others want it. An honest client
// answers within a few round trips, so a silent one gives way soon. A client that receives a page,
// which needs no token, has more time.
class StrangerPatience {
 public:
  // The silence after which a stranger gives way: the least, and the most for long round trips.
  static constexpr Time kSilence = std::chrono::milliseconds(500);
  static constexpr Time kMostSilence = std::chrono::seconds(2);
  // Fewer bytes do not end a silence: a handshake, or a client that reads slowly to stay.
  static constexpr std::uint64_t kProgressBytes = 4 * 1024;
  // The time for the handshake, for a request, and for a reply; and for a reply to a client that
  // receives at least this many bytes per second.
  static constexpr Time kPatience = kHandshakeDeadline;
  static constexpr Time kMostPatience = std::chrono::seconds(10);
  static constexpr std::uint64_t kLeastRate = 16 * 1024;

  explicit StrangerPatience(Time now) : begun_(now), progress_(now) {}

  // The client has made a step: its handshake is over, or its request has arrived. It has as much
  // time again for the next one.
  void Restart(Time now) {
    begun_ = progress_ = now;
    at_begin_ = last_;
  }

  struct Client {
    std::uint64_t bytes = 0;  // that have arrived, in all and in both directions
    Time round_trip{0};
  };
  // Call it several times per second. True: the stranger must go. `is_wanted`: others want the
  // place. Time counts only from then on.
  [[nodiscard]] bool IsOver(Time now, const Client& client, bool is_wanted) {
    last_ = client.bytes;
    if (!is_wanted) Restart(now);
    if (!is_wanted || last_ >= at_progress_ + kProgressBytes) {
      at_progress_ = last_;
      progress_ = now;
    }
    return now - progress_ >= SilenceOf(client.round_trip) || now - begun_ >= Patience(now);
  }

 private:
  [[nodiscard]] static Time SilenceOf(Time round_trip) {
    return std::clamp(4 * round_trip + Time(std::chrono::milliseconds(200)), kSilence,
                      kMostSilence);
  }
  [[nodiscard]] Time Patience(Time now) const {
    const auto milliseconds = std::chrono::duration_cast<std::chrono::milliseconds>(now - begun_);
    const std::uint64_t least =
        kLeastRate * static_cast<std::uint64_t>(milliseconds.count()) / 1000;
    return last_ - at_begin_ >= least ? kMostPatience : kPatience;
  }

  Time begun_;
  Time progress_;  // the last one
  std::uint64_t last_ = 0;
  std::uint64_t at_begin_ = 0;
  std::uint64_t at_progress_ = 0;
};

}  // namespace furrow::server

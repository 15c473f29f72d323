// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>

#include "server/core/time.h"
#include "server/tls/handshake.h"

namespace furrow::server {

// How long a stranger may keep its place (HandshakePlaces) while others want it. An honest client
// answers within a round trip, so a silent one gives way soon. A client that receives a page, which
// needs no token, has more time.
class StrangerPatience {
 public:
  static constexpr Time kSilence = std::chrono::milliseconds(500);
  // Fewer bytes are no progress: a handshake, or a client that reads slowly to stay.
  static constexpr std::uint64_t kProgressBytes = 16 * 1024;

  explicit StrangerPatience(Time now) : begun_(now), progress_(now) {}

  // The handshake is over: the client has as much time again to show who it is.
  void Restart(Time now) { begun_ = progress_ = now; }
  // Call it several times per second. True: the stranger must go. `received`: bytes of the daemon
  // that have arrived at the client, in all. `is_wanted`: others want the place.
  [[nodiscard]] bool IsOver(Time now, std::uint64_t received, bool is_wanted) {
    if (received >= received_ + kProgressBytes) {
      received_ = received;
      progress_ = now;
    }
    return is_wanted && (now - progress_ >= kSilence || now - begun_ >= kHandshakeDeadline);
  }

 private:
  Time begun_;
  Time progress_;  // the last one
  std::uint64_t received_ = 0;
};

}  // namespace furrow::server

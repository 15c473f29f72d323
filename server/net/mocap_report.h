// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "server/core/time.h"

namespace furrow::server {

// What has arrived at a mocap port. Without Asio's types, because the web side uses Boost's.
struct MocapReport {
  struct Arrival {
    std::string sender;  // numeric address
    Time at{0};
  };
  std::uint16_t port = 0;
  std::uint64_t packets = 0;    // datagrams
  std::uint64_t malformed = 0;  // of them, not understood
  std::uint64_t rejected = 0;   // of them, from senders that may not send now
  double rate_hz = 0.0;         // understood datagrams in the last full second
  std::string holder;           // the only sender that may send now; empty: anybody who is allowed
  // The last datagram of each kind; absent: none.
  std::optional<Arrival> last;
  std::optional<Arrival> last_malformed;
  std::optional<Arrival> last_rejected;
};

// The ports that the applications suggest.
inline constexpr std::uint16_t kLiveLinkFacePort = 11111;
inline constexpr std::uint16_t kVmcPort = 39539;

}  // namespace furrow::server

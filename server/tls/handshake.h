// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "protocol/secure/session/rate_budget.h"
#include "server/core/metrics.h"
#include "server/core/time.h"
#include "server/shares/host_rates.h"

namespace furrow::server {

// The time that a client has for a handshake, from its first byte to the last one. It holds a place
// of its host during that time.
inline constexpr auto kHandshakeDeadline = std::chrono::seconds(5);

// The number of bytes that LooksLikeTls() needs to be sure.
inline constexpr std::size_t kTlsPrefixBytes = 3;
// True if a connection begins like TLS: a handshake record of version 3.x (RFC 8446 section 5.1).
// Fewer bytes than kTlsPrefixBytes are compared as far as they go.
[[nodiscard]] bool LooksLikeTls(std::span<const std::uint8_t> bytes);

// The counter of a handshake that has failed. `code`: of OpenSSL, or any other number.
[[nodiscard]] Counter HandshakeFailure(unsigned long code);

// Limits how often handshakes begin, because each costs the processor a signature: per host, so
// that no host uses up what the others need, and altogether. When a few hosts have used up the
// total, the others still have a reserve. Not thread-safe.
class HandshakeBudget {
 public:
  // All per second.
  static constexpr std::uint32_t kPerHost = 100;
  static constexpr std::uint32_t kTotal = 200;
  static constexpr std::uint32_t kReservePerHost = 5;
  static constexpr std::uint32_t kReserve = 100;

  // False, without effect on others, if the budget is used up. `host`: see HostOf().
  [[nodiscard]] bool Take(const std::string& host, Time now);

 private:
  HostRates hosts_{kPerHost};
  protocol::secure::RateBudget total_{kTotal};
  HostRates reserves_{kReservePerHost};
  protocol::secure::RateBudget reserve_{kReserve};
};

}  // namespace furrow::server

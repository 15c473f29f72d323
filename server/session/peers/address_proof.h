// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>

#include "protocol/secure/crypto/secret.h"
#include "server/core/time.h"

namespace furrow::server {

// An IPv6 address, or an IPv4 address mapped into IPv6, and a port (big-endian).
using UdpAddress = std::array<std::uint8_t, 18>;

// Makes and checks the tokens that prove a UDP address (STANDARD.md section 4). Nothing is
// remembered: a token is a keyed hash of the address, the sender's session and the time, so any
// number of forged addresses costs no memory.
//
// The hash is keyed BLAKE2b, of which a token holds 64 bits. Safe to use on several threads.
class AddressProof {
 public:
  // How long a token is valid at least; at most twice as long.
  static constexpr Time kSlot = std::chrono::seconds(60);

  // `key`: unpredictable, and different at every start of the daemon.
  using Key = std::array<std::uint8_t, 32>;
  explicit AddressProof(const Key& key);

  // The token for a Welcome; never 0.
  [[nodiscard]] std::uint64_t Token(const UdpAddress& address, std::uint64_t session,
                                    Time now) const;
  // True if Token() made this token for the same address and session, not too long ago.
  [[nodiscard]] bool Check(const UdpAddress& address, std::uint64_t session, std::uint64_t token,
                           Time now) const;

 private:
  [[nodiscard]] std::uint64_t Hash(const UdpAddress& address, std::uint64_t session,
                                   std::int64_t slot) const;

  protocol::secure::Key key_;
};

}  // namespace furrow::server

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace furrow::protocol::secure {

// The address of a peer, free of any socket library. IPv4 addresses are written as IPv6 addresses
// that map them (::ffff:a.b.c.d).
struct PeerAddress {
  std::array<std::uint8_t, 16> host{};
  std::uint16_t port = 0;

  friend bool operator==(const PeerAddress&, const PeerAddress&) = default;
};

[[nodiscard]] inline PeerAddress FromIpv4(std::array<std::uint8_t, 4> host, std::uint16_t port) {
  PeerAddress address;
  address.host[10] = address.host[11] = 0xFF;
  for (std::size_t i = 0; i < 4; ++i) address.host[12 + i] = host[i];
  address.port = port;
  return address;
}

}  // namespace furrow::protocol::secure

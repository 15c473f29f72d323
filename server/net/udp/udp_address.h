// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include <asio/ip/udp.hpp>

#include "protocol/secure/handshake/peer_address.h"

namespace furrow::server {

// The address of a socket in the form of the sealed datagrams, and back. IPv4 addresses are mapped
// into IPv6; `v4`: the socket that sends to it has IPv4. `scope`: the interface of a link-local
// address, which the sealed datagrams do not know; 0 for others.
inline protocol::secure::PeerAddress ToPeerAddress(const asio::ip::udp::endpoint& endpoint) {
  const auto ip = endpoint.address().is_v4()
                      ? asio::ip::make_address_v6(asio::ip::v4_mapped, endpoint.address().to_v4())
                      : endpoint.address().to_v6();
  protocol::secure::PeerAddress address;
  std::ranges::copy(ip.to_bytes(), address.host.begin());
  address.port = endpoint.port();
  return address;
}

inline std::uint32_t ScopeOf(const asio::ip::udp::endpoint& endpoint) {
  return endpoint.address().is_v6()
             ? static_cast<std::uint32_t>(endpoint.address().to_v6().scope_id())
             : 0;
}

inline asio::ip::udp::endpoint ToEndpoint(const protocol::secure::PeerAddress& address, bool v4,
                                          std::uint32_t scope) {
  const asio::ip::address_v6 ip(address.host, scope);
  if (!v4) return {ip, address.port};
  return {asio::ip::make_address_v4(asio::ip::v4_mapped, ip), address.port};
}

}  // namespace furrow::server

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include <asio/ip/udp.hpp>

#include "protocol/secure/handshake/peer_address.h"

namespace furrow::server {

// The address of a socket in the form of the sealed datagrams, and back. IPv4 addresses are mapped
// into IPv6; `v4`: the socket that sends to it has IPv4.
inline protocol::secure::PeerAddress ToPeerAddress(const asio::ip::udp::endpoint& endpoint) {
  const auto ip = endpoint.address().is_v4()
                      ? asio::ip::make_address_v6(asio::ip::v4_mapped, endpoint.address().to_v4())
                      : endpoint.address().to_v6();
  protocol::secure::PeerAddress address;
  std::ranges::copy(ip.to_bytes(), address.host.begin());
  address.port = endpoint.port();
  return address;
}

inline asio::ip::udp::endpoint ToEndpoint(const protocol::secure::PeerAddress& address, bool v4) {
  const asio::ip::address_v6 ip(address.host);
  if (!v4) return {ip, address.port};
  return {asio::ip::make_address_v4(asio::ip::v4_mapped, ip), address.port};
}

}  // namespace furrow::server

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include <asio/ip/udp.hpp>

#include "protocol/codec/codec.h"
#include "server/net/clock.h"
#include "server/session/hub.h"

namespace furrow::server {

// The Hello that makes the loopback address of `socket` a peer of `hub`, without the exchange
// before it. Binds the socket if it has no port yet.
inline std::vector<std::uint8_t> ProvenHello(const Hub& hub, asio::ip::udp::socket& socket,
                                             std::uint64_t session = 77) {
  using asio::ip::udp;
  if (socket.local_endpoint().port() == 0) {
    socket.bind({asio::ip::address_v4::loopback(), 0});
  }
  const std::uint16_t port = socket.local_endpoint().port();
  UdpAddress address{};
  const auto ip =
      asio::ip::make_address_v6(asio::ip::v4_mapped, asio::ip::address_v4::loopback()).to_bytes();
  std::ranges::copy(ip, address.begin());
  address[16] = static_cast<std::uint8_t>(port >> 8);
  address[17] = static_cast<std::uint8_t>(port & 0xFF);
  std::vector<std::uint8_t> hello;
  protocol::Encoder().Encode(
      {.session = session},
      protocol::Hello{"test", hub.address_proof().Token(address, session, ReadClock())}, hello);
  return hello;
}

}  // namespace furrow::server

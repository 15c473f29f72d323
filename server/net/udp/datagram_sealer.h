// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include <asio/ip/udp.hpp>

namespace furrow::server {

// Seals the datagrams of secure sessions as they leave.
class DatagramSealer {
 public:
  virtual ~DatagramSealer() = default;
  // Seals `packet` for the client of a session, in place (protocol/secure PacketSealer::Seal), and
  // sets `to` to the client's present address. False: the session has ended.
  [[nodiscard]] virtual bool Seal(std::uint32_t session, std::span<std::uint8_t> packet,
                                  asio::ip::udp::endpoint& to) = 0;
};

}  // namespace furrow::server

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <asio/io_context.hpp>
#include <asio/ip/udp.hpp>

#include "client/cpp/transport.h"

namespace furrow::client {

// The time of a steady clock as a number.
[[nodiscard]] inline std::int64_t Microseconds(std::chrono::steady_clock::time_point time) {
  return std::chrono::duration_cast<std::chrono::microseconds>(time.time_since_epoch()).count();
}

// A UDP socket that is connected to one peer. Below UdpTransport and SecureTransport.
class DatagramSocket {
 public:
  using Clock = std::chrono::steady_clock;

  // Error: the name does not resolve, or there is no route. Sends nothing.
  [[nodiscard]] asio::error_code Connect(const std::string& host, std::uint16_t port);

  // kOk or kNoConnection: the peer's port was closed when an earlier datagram arrived there, or
  // there is no route.
  [[nodiscard]] IoStatus Send(std::span<const std::uint8_t> datagram);

  // Waits for a datagram until the deadline; one in the past: does not wait. On kOk, `datagram` is
  // valid until the next call. kTimeout, kNoConnection.
  [[nodiscard]] IoStatus Receive(Clock::time_point deadline, std::span<std::uint8_t>& datagram);

 private:
  bool SetWait(std::chrono::milliseconds wait);

  asio::io_context context_{1};
  asio::ip::udp::socket socket_{context_};
  std::chrono::milliseconds wait_{0};  // set by SetWait(); 0: none yet
  std::vector<std::uint8_t> buffer_ = std::vector<std::uint8_t>(64 * 1024);
  bool refused_ = false;
};

}  // namespace furrow::client

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cerrno>

#include <asio/error.hpp>
#include <asio/ip/udp.hpp>
#include <sys/socket.h>

namespace furrow::server {

// The address and port that a UDP or TCP socket is bound to. For sockets that Asio does not know.
[[nodiscard]] inline asio::ip::udp::endpoint LocalEndpoint(int socket, asio::error_code& error) {
  asio::ip::udp::endpoint endpoint;
  auto size = static_cast<socklen_t>(endpoint.capacity());
  if (getsockname(socket, endpoint.data(), &size) != 0) {
    error = {errno, asio::error::get_system_category()};
  } else {
    endpoint.resize(size);
    error = {};
  }
  return endpoint;
}

}  // namespace furrow::server

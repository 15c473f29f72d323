// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <sys/socket.h>

namespace furrow::server {

// A number that the kernel gives to one socket only, and that stays the same when the socket goes
// to another process; 0 if there is none.
[[nodiscard]] inline std::uint64_t SocketCookie(int socket) {
  std::uint64_t cookie = 0;
  socklen_t size = sizeof(cookie);
  return getsockopt(socket, SOL_SOCKET, SO_COOKIE, &cookie, &size) == 0 ? cookie : 0;
}

}  // namespace furrow::server

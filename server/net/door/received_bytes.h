// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

namespace furrow::server {

// The bytes that the other end of a TCP connection has acknowledged in all; 0 if the kernel does
// not know.
[[nodiscard]] inline std::uint64_t ReceivedByPeer(int socket) {
  // The kernel's structure (linux/tcp.h) goes on where that of the C library ends. Both headers
  // cannot be included together.
  struct Info {
    tcp_info known;
    std::uint64_t pacing_rate;
    std::uint64_t max_pacing_rate;
    std::uint64_t bytes_acked;
  };
  static_assert(sizeof(tcp_info) == 104 && sizeof(Info) == 128);
  Info info{};
  socklen_t size = sizeof(info);
  if (getsockopt(socket, IPPROTO_TCP, TCP_INFO, &info, &size) != 0) return 0;
  return info.bytes_acked;  // 0 if the kernel is older than the field
}

}  // namespace furrow::server

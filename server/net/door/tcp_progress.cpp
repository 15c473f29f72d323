// SPDX-License-Identifier: Apache-2.0
#include "server/net/door/tcp_progress.h"

#include <chrono>

// The kernel's structure has fields that the C library's lacks. <netinet/tcp.h> cannot be included
// together with this header.
#include <linux/tcp.h>
#include <netinet/in.h>
#include <sys/socket.h>

namespace furrow::server {

StrangerPatience::Client ReadTcpProgress(int socket) {
  tcp_info info{};  // an older kernel leaves the fields that it does not know at 0
  socklen_t size = sizeof(info);
  if (getsockopt(socket, IPPROTO_TCP, TCP_INFO, &info, &size) != 0) return {};
  return {.bytes = info.tcpi_bytes_acked + info.tcpi_bytes_received,
          .round_trip = std::chrono::microseconds(info.tcpi_rtt)};
}

}  // namespace furrow::server

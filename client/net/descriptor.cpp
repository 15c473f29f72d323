// SPDX-License-Identifier: Apache-2.0
#include "client/net/descriptor.h"

#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>

namespace furrow::net {

bool WaitFor(int descriptor, short events, std::chrono::milliseconds timeout) {
  pollfd wanted{descriptor, events, 0};
  // A signal also ends the wait. Callers then try their call again or report a timeout.
  return poll(&wanted, 1, static_cast<int>(timeout.count())) > 0;
}

std::string PeerHost(int descriptor) {
  sockaddr_storage address{};
  socklen_t size = sizeof(address);
  auto* const plain = reinterpret_cast<sockaddr*>(&address);
  char host[NI_MAXHOST] = "";
  if (getpeername(descriptor, plain, &size) != 0 ||
      getnameinfo(plain, size, host, sizeof(host), nullptr, 0, NI_NUMERICHOST) != 0) {
    return {};
  }
  return host;
}

}  // namespace furrow::net

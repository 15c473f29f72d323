// SPDX-License-Identifier: Apache-2.0
#include "client/load/net/socket.h"

#include <cerrno>
#include <cstring>
#include <span>
#include <utility>

#include <fcntl.h>
#include <netdb.h>
#include <poll.h>
#include <unistd.h>

#include "client/load/net/tcp_socket.h"
#include "client/load/net/udp_socket.h"

namespace furrow::load {
namespace {

using client::TransportKind;

struct FreeAddresses {
  void operator()(addrinfo* list) const { freeaddrinfo(list); }
};

// Connects, for TCP within three seconds. 0, or an error number.
int Connect(int descriptor, const addrinfo& address) {
  if (connect(descriptor, address.ai_addr, address.ai_addrlen) == 0) return 0;
  if (errno != EINPROGRESS) return errno;
  if (!WaitFor(descriptor, POLLOUT, std::chrono::milliseconds(3000))) return ETIMEDOUT;
  int error = 0;
  socklen_t size = sizeof(error);
  getsockopt(descriptor, SOL_SOCKET, SO_ERROR, &error, &size);
  return error;
}

// IPv4 first, as the daemon's default binds; else the last reason.
int ConnectAny(const addrinfo* list, Descriptor* connected) {
  int error = EADDRNOTAVAIL;
  for (const int family : {AF_INET, AF_INET6}) {
    for (const addrinfo* entry = list; entry != nullptr; entry = entry->ai_next) {
      if (entry->ai_family != family) continue;
      Descriptor made(socket(family, entry->ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
      error = made.get() < 0 ? errno : Connect(made.get(), *entry);
      if (error != 0) continue;
      *connected = std::move(made);
      return 0;
    }
  }
  return error;
}

}  // namespace

Descriptor::~Descriptor() {
  if (value_ >= 0) close(value_);
}

Descriptor::Descriptor(Descriptor&& other) noexcept : value_(std::exchange(other.value_, -1)) {}

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  std::swap(value_, other.value_);
  return *this;
}

bool WaitFor(int descriptor, short events, std::chrono::milliseconds timeout) {
  pollfd wanted{descriptor, events, 0};
  return poll(&wanted, 1, static_cast<int>(timeout.count())) > 0;
}

Descriptor OpenDescriptor(TransportKind kind, const std::string& host, std::uint16_t port,
                          std::string* error) {
  const bool tcp = kind == TransportKind::kTcp;
  addrinfo hints{};
  hints.ai_socktype = tcp ? SOCK_STREAM : SOCK_DGRAM;
  addrinfo* list = nullptr;
  const int unresolved = getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &list);
  const std::unique_ptr<addrinfo, FreeAddresses> addresses(list);
  Descriptor descriptor;
  std::string why;
  if (unresolved != 0) {
    why = gai_strerror(unresolved);
  } else if (const int failed = ConnectAny(addresses.get(), &descriptor); failed != 0) {
    why = std::strerror(failed);
  }
  if (!why.empty()) {
    *error = "no connection to " + host + ":" + std::to_string(port) + " over " +
             (tcp ? "TCP: " : "UDP: ") + why;
  }
  return descriptor;
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

std::unique_ptr<Socket> Socket::Open(TransportKind kind, const std::string& host,
                                     std::uint16_t port, std::string* error) {
  Descriptor descriptor = OpenDescriptor(kind, host, port, error);
  if (descriptor.get() < 0) return nullptr;
  if (kind == TransportKind::kTcp) return std::make_unique<TcpSocket>(std::move(descriptor));
  return std::make_unique<UdpSocket>(std::move(descriptor));
}

}  // namespace furrow::load

// SPDX-License-Identifier: Apache-2.0
#include "client/net/open_socket.h"

#include <cerrno>
#include <chrono>
#include <cstring>
#include <utility>

#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>

#include "client/net/descriptor.h"
#include "client/net/tcp_socket.h"
#include "client/net/udp_socket.h"

namespace furrow::net {
namespace {

using client::TransportKind;

constexpr std::chrono::milliseconds kConnectTimeout{3000};

struct FreeAddresses {
  void operator()(addrinfo* list) const { freeaddrinfo(list); }
};

// Returns 0 or an error number.
int Connect(int descriptor, const addrinfo& address) {
  if (connect(descriptor, address.ai_addr, address.ai_addrlen) == 0) return 0;
  if (errno != EINPROGRESS) return errno;
  // A pending connect has ended when the socket is writable; SO_ERROR tells how (connect(2)).
  if (!WaitFor(descriptor, POLLOUT, kConnectTimeout)) return ETIMEDOUT;
  int error = 0;
  socklen_t size = sizeof(error);
  getsockopt(descriptor, SOL_SOCKET, SO_ERROR, &error, &size);
  return error;
}

// Tries every address, IPv4 first. Returns 0, or the error number of the last attempt.
int ConnectAny(const addrinfo* list, Descriptor* connected) {
  int error = EADDRNOTAVAIL;
  for (const int family : {AF_INET, AF_INET6}) {
    for (const addrinfo* entry = list; entry != nullptr; entry = entry->ai_next) {
      if (entry->ai_family != family) continue;
      // CLOEXEC: programs that are started later must not inherit the connection.
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

Result<Descriptor> OpenDescriptor(TransportKind kind, const std::string& host, std::uint16_t port) {
  const bool tcp = kind == TransportKind::kTcp;
  addrinfo hints{};
  hints.ai_socktype = tcp ? SOCK_STREAM : SOCK_DGRAM;
  addrinfo* list = nullptr;
  const int unresolved = getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &list);
  const std::unique_ptr<addrinfo, FreeAddresses> addresses(list);
  Descriptor descriptor;
  if (unresolved == EAI_NONAME || unresolved == EAI_AGAIN || unresolved == EAI_NODATA)
    return client::HostNotFound(host);
  if (unresolved != 0) {
    return client::ConnectionFailed(
        kind, host, port,
        unresolved == EAI_SYSTEM ? std::strerror(errno) : gai_strerror(unresolved));
  }
  if (const int failed = ConnectAny(addresses.get(), &descriptor); failed != 0)
    return client::ConnectionFailed(kind, host, port, std::strerror(failed));
  return descriptor;
}

Result<std::unique_ptr<Socket>> OpenSocket(TransportKind kind, const std::string& host,
                                           std::uint16_t port, const client::Security& security,
                                           const std::string& certificate_host) {
  const client::Token* const token = security.token ? &*security.token : nullptr;
  auto descriptor = OpenDescriptor(kind, host, port);
  FURROW_RETURN_IF_ERROR(descriptor);
  if (kind == TransportKind::kTcp) {
    auto socket = std::make_unique<TcpSocket>(*std::move(descriptor));
    if (security.tls != nullptr) {
      const std::string why =
          socket->StartTls(security.tls.get(), certificate_host.empty() ? host : certificate_host,
                           std::chrono::steady_clock::now() + kConnectTimeout);
      if (!why.empty()) {
        return Status(StatusCode::kInvalidArgument,
                      "no connection to " + client::AddressText(host, port) + " over TLS: " + why);
      }
    }
    if (token != nullptr) (void)socket->Send(client::TokenGreeting(*token));
    return std::unique_ptr<Socket>(std::move(socket));
  }
  auto socket = std::make_unique<UdpSocket>(*std::move(descriptor), token);
  const std::string why = socket->AwaitSession(kConnectTimeout);
  if (why.empty()) return std::unique_ptr<Socket>(std::move(socket));
  if (socket->refusal() == protocol::secure::Refusal::kNone) {
    return client::ConnectionFailed(kind, host, port, why);
  }
  return Status(StatusCode::kInvalidArgument, why, client::AddressText(host, port));
}

}  // namespace furrow::net

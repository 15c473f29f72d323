// SPDX-License-Identifier: Apache-2.0
#include "client/net/open_socket.h"

#include <cerrno>
#include <chrono>
#include <cstddef>
#include <utility>

#include <asio/error.hpp>
#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/ip/udp.hpp>
#include <poll.h>
#include <sys/socket.h>

#include "client/cpp/connect_error.h"
#include "client/net/descriptor.h"
#include "client/net/tcp_socket.h"
#include "client/net/udp_socket.h"

namespace furrow::net {
namespace {

using client::TransportKind;

constexpr std::chrono::milliseconds kConnectTimeout{3000};

// Returns 0 or an error number.
int Connect(int descriptor, const sockaddr* address, std::size_t bytes) {
  if (connect(descriptor, address, static_cast<socklen_t>(bytes)) == 0) return 0;
  if (errno != EINPROGRESS) return errno;
  // A pending connect has ended when the socket is writable; SO_ERROR tells how (connect(2)).
  if (!WaitFor(descriptor, POLLOUT, kConnectTimeout)) return ETIMEDOUT;
  int error = 0;
  socklen_t size = sizeof(error);
  getsockopt(descriptor, SOL_SOCKET, SO_ERROR, &error, &size);
  return error;
}

// Tries every address of the host, IPv4 first. Returns the resolver's error or that of the last
// attempt.
template <class Protocol>
asio::error_code ConnectAny(const std::string& host, std::uint16_t port, Descriptor* connected) {
  asio::io_context context;
  typename Protocol::resolver resolver(context);
  asio::error_code error;
  const auto found = resolver.resolve(host, std::to_string(port), error);
  if (error) return error;
  int failed = EADDRNOTAVAIL;
  for (const int family : {AF_INET, AF_INET6}) {
    for (const auto& entry : found) {
      const typename Protocol::endpoint endpoint = entry.endpoint();
      const Protocol protocol = endpoint.protocol();
      if (protocol.family() != family) continue;
      // CLOEXEC: programs that are started later must not inherit the connection.
      Descriptor made(socket(family, protocol.type() | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
      failed = made.get() < 0 ? errno : Connect(made.get(), endpoint.data(), endpoint.size());
      if (failed != 0) continue;
      *connected = std::move(made);
      return {};
    }
  }
  return {failed, asio::error::get_system_category()};
}

}  // namespace

Result<Descriptor> OpenDescriptor(TransportKind kind, const std::string& host, std::uint16_t port) {
  Descriptor descriptor;
  const asio::error_code error = kind == TransportKind::kTcp
                                     ? ConnectAny<asio::ip::tcp>(host, port, &descriptor)
                                     : ConnectAny<asio::ip::udp>(host, port, &descriptor);
  if (error) return client::ConnectError(kind, host, port, error);
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
      FURROW_RETURN_IF_ERROR(socket->StartTls(
          security.tls.get(), certificate_host.empty() ? host : certificate_host, host, port));
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

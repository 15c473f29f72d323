// SPDX-License-Identifier: Apache-2.0
#include "client/net/tcp_socket.h"

#include <cerrno>
#include <utility>

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include "client/cpp/tls/client_tls.h"
#include "client/net/clock.h"
#include "client/net/descriptor.h"

namespace furrow::net {

using client::IoStatus;

namespace {

constexpr std::chrono::milliseconds kSendTimeout{5000};

}  // namespace

TcpSocket::TcpSocket(Descriptor descriptor)
    : Socket(client::TransportKind::kTcp), descriptor_(std::move(descriptor)) {
  const int on = 1;
  // Nagle's algorithm would hold a pose back until the one before is acknowledged.
  setsockopt(descriptor_.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
}

Status TcpSocket::StartTls(SSL_CTX* context, const std::string& certificate_host,
                           const std::string& host, std::uint16_t port) {
  const auto deadline = std::chrono::steady_clock::now() + client::kTlsConnectTimeout;
  tls_ = std::make_unique<client::TlsSession>(context, certificate_host);
  for (;;) {
    const client::TlsSession::Progress progress = tls_->Handshake();
    // Also after a failure: the alert tells the peer.
    tls_->TakeOutgoing(&sealed_);
    const bool is_closed = SendAll(sealed_) != IoStatus::kOk;
    if (progress == client::TlsSession::Progress::kFailed) {
      return {StatusCode::kInvalidArgument, "no connection to " + client::AddressText(host, port) +
                                                " over TLS: " + tls_->failure()};
    }
    if (progress == client::TlsSession::Progress::kDone) return {};
    const auto left =
        std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
    if (left.count() <= 0 || !WaitFor(descriptor_.get(), POLLIN, left)) {
      return client::HandshakeCut(host, port, /*is_closed=*/false);
    }
    const ssize_t received = recv(descriptor_.get(), buffer_.data(), buffer_.size(), 0);
    if (received < 0 && (errno == EAGAIN || errno == EINTR)) continue;
    if (received <= 0 || is_closed) return client::HandshakeCut(host, port, /*is_closed=*/true);
    tls_->Feed(std::span(buffer_).first(static_cast<std::size_t>(received)));
  }
}

IoStatus TcpSocket::Send(std::span<const std::uint8_t> message) {
  if (message.size() > protocol::kMaxRequestBytes) return IoStatus::kTooLarge;
  const auto prefix = protocol::FramePrefix(message.size());
  // Prefix and message in one buffer, so that they leave in one segment.
  outgoing_.assign(prefix.begin(), prefix.end());
  outgoing_.insert(outgoing_.end(), message.begin(), message.end());
  if (tls_ == nullptr) return SendAll(outgoing_);
  tls_->Encrypt(outgoing_);
  tls_->TakeOutgoing(&sealed_);
  return SendAll(sealed_);
}

IoStatus TcpSocket::SendAll(std::span<const std::uint8_t> bytes) {
  std::size_t sent = 0;
  // MSG_NOSIGNAL: a closed connection is a result, not a SIGPIPE that kills the load test.
  while (sent < bytes.size()) {
    const ssize_t taken =
        send(descriptor_.get(), bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (taken >= 0) {
      sent += static_cast<std::size_t>(taken);
    } else if (errno != EAGAIN && errno != EINTR) {
      return IoStatus::kClosed;
    } else if (!WaitFor(descriptor_.get(), POLLOUT, kSendTimeout)) {
      return IoStatus::kClosed;
    }
  }
  return IoStatus::kOk;
}

IoStatus TcpSocket::Receive(std::span<const std::uint8_t>& message,
                            std::chrono::milliseconds timeout) {
  for (;;) {
    if (!unread_.empty()) {
      switch (frames_.Push(unread_, message)) {
        case protocol::FrameStatus::kFrame: return IoStatus::kOk;
        case protocol::FrameStatus::kBadLength: return IoStatus::kMalformed;
        case protocol::FrameStatus::kNeedMore: break;
      }
    }
    // The last read emptied the kernel's buffer. Saying so now saves a recv() that would find
    // nothing.
    if (std::exchange(drained_, false)) return IoStatus::kTimeout;
    // Only the first read waits. A frame that arrives in pieces must not extend the timeout.
    const IoStatus status = Fill(std::exchange(timeout, {}));
    if (status != IoStatus::kOk) return status;
  }
}

IoStatus TcpSocket::Fill(std::chrono::milliseconds timeout) {
  if (timeout.count() > 0) WaitFor(descriptor_.get(), POLLIN, timeout);
  const ssize_t received = recv(descriptor_.get(), buffer_.data(), buffer_.size(), 0);
  if (received < 0 && (errno == EAGAIN || errno == EINTR)) return IoStatus::kTimeout;
  if (received <= 0) return IoStatus::kClosed;
  read_ns_ = SteadyNanoseconds();
  const auto bytes = static_cast<std::size_t>(received);
  unread_ = std::span<const std::uint8_t>(buffer_).first(bytes);
  drained_ = bytes < buffer_.size();
  if (tls_ == nullptr) return IoStatus::kOk;
  tls_->Feed(unread_);
  const bool goes_on = tls_->Decrypt(&plain_);
  unread_ = plain_;
  // What came before the end is still handed out, and the next read finds the end.
  if (!goes_on && plain_.empty()) return IoStatus::kClosed;
  tls_->TakeOutgoing(&sealed_);  // the answer to a change of keys
  return SendAll(sealed_);
}

}  // namespace furrow::net

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/process/descriptor.h"
#include "base/status.h"
#include "client/cpp/tls/tls_session.h"
#include "client/net/socket.h"
#include "protocol/framing/tcp_framing.h"
#include "protocol/messages/limits.h"

namespace furrow::net {

// A connected TCP socket, with or without TLS. Send() blocks while the peer's buffer is full, for 5
// seconds at most, and then returns kClosed.
class TcpSocket : public Socket {
 public:
  explicit TcpSocket(Descriptor descriptor);
  // Speaks TLS from now on, and waits up to client::kTlsConnectTimeout for the end of the
  // handshake. Call it before the first message. `certificate_host`: the name or address that the
  // certificate must be for; `host` and `port` are for messages. Errors: kUnavailable
  // (client::HandshakeCut()), kInvalidArgument (TLS failed).
  [[nodiscard]] Status StartTls(SSL_CTX* context, const std::string& certificate_host,
                                const std::string& host, std::uint16_t port);

  [[nodiscard]] client::IoStatus Send(std::span<const std::uint8_t> message) override;
  [[nodiscard]] client::IoStatus Receive(std::span<const std::uint8_t>& message,
                                         std::chrono::milliseconds timeout) override;
  [[nodiscard]] int descriptor() const override { return descriptor_.get(); }
  [[nodiscard]] bool holds() const override { return !unread_.empty(); }
  [[nodiscard]] std::int64_t arrived_ns() const override { return read_ns_; }

 private:
  [[nodiscard]] client::IoStatus Fill(std::chrono::milliseconds timeout);
  [[nodiscard]] client::IoStatus SendAll(std::span<const std::uint8_t> bytes);

  Descriptor descriptor_;
  std::unique_ptr<client::TlsSession> tls_;  // null: plain TCP
  std::vector<std::uint8_t> outgoing_;
  std::vector<std::uint8_t> sealed_;  // outgoing_ in TLS
  std::vector<std::uint8_t> plain_;   // what TLS has decrypted
  std::vector<std::uint8_t> buffer_ = std::vector<std::uint8_t>(64 * 1024);
  std::span<const std::uint8_t> unread_;
  std::int64_t read_ns_ = 0;  // time of the last read
  bool drained_ = false;      // the last read did not fill the buffer, so no data is left for now
  protocol::FrameReader frames_{protocol::kMaxReplyBytes};
};

}  // namespace furrow::net

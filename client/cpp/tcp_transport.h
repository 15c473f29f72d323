// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/ssl/stream.hpp>

#include "base/layered_stream.h"
#include "client/cpp/tls/security.h"
#include "client/cpp/transport.h"
#include "protocol/framing/tcp_framing.h"
#include "protocol/messages/limits.h"

namespace furrow::client {

// Messages over TCP, with or without TLS.
class TcpTransport : public Transport {
 public:
  using Clock = std::chrono::steady_clock;

  // `send_timeout`: limits each Send() to a slow peer.
  TcpTransport(std::chrono::milliseconds send_timeout, Security security);

  // Begins to connect, and with TLS to shake hands. Errors: kUnavailable (the name does not
  // resolve), kInvalidArgument (the token would travel in clear to another computer).
  [[nodiscard]] Status Begin(const std::string& host, std::uint16_t port);
  // Waits until the connection is complete. Errors: kUnavailable (also if the daemon closes the
  // connection during the handshake), and kInvalidArgument for what time does not mend, such as a
  // certificate of another host.
  [[nodiscard]] Status Await(Clock::time_point deadline);
  // True if the daemon has closed the connection during the handshake, so it may be busy.
  [[nodiscard]] bool handshake_cut() const { return handshake_cut_; }

  [[nodiscard]] bool connected() const override { return result_ && result_->ok(); }
  // Also counts a handshake that is not complete, because the caller has given up waiting for it.
  [[nodiscard]] std::string failure() const override;
  [[nodiscard]] bool tls_failed() const override { return tls_failed_; }
  [[nodiscard]] std::chrono::microseconds connect_timeout() const override;

  [[nodiscard]] IoStatus Send(std::span<const std::uint8_t> message) override;
  [[nodiscard]] IoStatus Receive(std::span<const std::uint8_t>& message,
                                 std::chrono::milliseconds timeout) override;

 private:
  using Socket = asio::ip::tcp::socket;
  using Stream = LayeredStream<Socket, asio::ssl::stream<Socket&>>;

  [[nodiscard]] bool shakes_hands() const { return !result_ && stream_.upper() != nullptr; }
  void OnConnected(const asio::error_code& error);
  void OnHandshake(const asio::error_code& error);
  void Finish(Status result);
  void FailTls(std::string reason);
  void Fail(const std::string& reason);
  void StartRead();
  template <class Done>
  void RunUntil(Clock::time_point deadline, const Done& done);
  bool AwaitRead(Clock::time_point deadline);
  bool AwaitConnect(Clock::time_point deadline);
  IoStatus OnReadError();
  void Close();

  std::chrono::milliseconds send_timeout_;
  Security security_;
  std::vector<std::uint8_t> greeting_;  // sent before everything else
  std::string host_;
  std::uint16_t port_ = 0;
  asio::io_context context_{1};
  Stream stream_{context_};
  std::optional<Status> result_;  // of the connect; nothing: not known yet
  std::string failure_;
  bool tls_failed_ = false;
  bool handshake_cut_ = false;
  // One read is always pending, so a timeout never loses data.
  bool read_pending_ = false;
  bool read_done_ = false;
  asio::error_code read_error_;
  std::vector<std::uint8_t> buffer_ = std::vector<std::uint8_t>(64 * 1024);
  std::span<const std::uint8_t> unread_;
  std::size_t read_bytes_ = 0;
  std::vector<std::uint8_t> frame_;  // being sent
  protocol::FrameReader frames_{protocol::kMaxReplyBytes};
};

}  // namespace furrow::client

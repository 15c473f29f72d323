// SPDX-License-Identifier: Apache-2.0
#include "client/cpp/transports.h"

#include <array>
#include <optional>
#include <vector>

#include <asio/buffer.hpp>
#include <asio/connect.hpp>
#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/write.hpp>

#include "client/cpp/datagram_socket.h"
#include "client/cpp/secure_transport.h"
#include "protocol/framing/bundle.h"
#include "protocol/framing/fragment.h"
#include "protocol/framing/tcp_framing.h"
#include "protocol/messages/limits.h"

namespace furrow::client {
namespace {

using asio::ip::tcp;
using Clock = std::chrono::steady_clock;

// Keeps one asynchronous read pending. A wait runs the context until the read completes or the
// deadline passes, so a timeout never loses data.
class ReadPump {
 public:
  void Start(tcp::socket& socket, std::span<std::uint8_t> buffer) {
    // Send() runs the context too, so a completed read may still wait to be taken.
    if (pending_ || done_) return;
    pending_ = true;
    socket.async_read_some(asio::buffer(buffer.data(), buffer.size()),
                           [this](const asio::error_code& error, std::size_t bytes) {
                             pending_ = false;
                             done_ = true;
                             error_ = error;
                             bytes_ = bytes;
                           });
  }

  // Returns true when the read has completed; error() and bytes() then hold its result.
  bool Wait(asio::io_context& context, Clock::time_point deadline) {
    if (!done_) {
      // A context without work stops, and a stopped context runs nothing.
      context.restart();
      // Runs one handler at most: that of the read, or none until the deadline.
      context.run_one_until(deadline);
      // With a deadline in the past nothing has run yet, although data may be waiting.
      if (!done_) context.poll();
    }
    return std::exchange(done_, false);
  }

  [[nodiscard]] const asio::error_code& error() const { return error_; }
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

 private:
  bool pending_ = false;
  bool done_ = false;
  asio::error_code error_;
  std::size_t bytes_ = 0;
};

class TcpTransport : public Transport {
 public:
  TcpTransport(std::chrono::milliseconds send_timeout, const Token* token)
      : Transport(TransportKind::kTcp), send_timeout_(send_timeout) {
    if (token != nullptr) greeting_ = TokenGreeting(*token);
  }

  asio::error_code Begin(const std::string& host, std::uint16_t port) {
    asio::error_code error;
    tcp::resolver resolver(context_);
    const auto endpoints = resolver.resolve(host, std::to_string(port), error);
    if (error) return error;
    asio::async_connect(socket_, endpoints,
                        [this](const asio::error_code& result, const tcp::endpoint&) {
                          connect_result_ = result;
                          asio::error_code ignored;
                          if (!result) socket_.set_option(tcp::no_delay(true), ignored);
                        });
    return {};
  }

  asio::error_code Connect(const std::string& host, std::uint16_t port,
                           Clock::time_point deadline) {
    if (const asio::error_code error = Begin(host, port)) return error;
    if (!AwaitConnect(deadline)) {
      Close();
      return asio::error::timed_out;
    }
    return *connect_result_;
  }

  [[nodiscard]] bool connected() const override { return connect_result_ && !*connect_result_; }
  [[nodiscard]] std::string failure() const override {
    return connect_result_ && *connect_result_ ? connect_result_->message() : std::string();
  }

  IoStatus Send(std::span<const std::uint8_t> message) override {
    if (message.size() > protocol::kMaxRequestBytes) return IoStatus::kTooLarge;
    if (!connected()) return IoStatus::kNoConnection;
    if (!greeting_.empty()) {
      const auto greeting = std::exchange(greeting_, {});
      if (const IoStatus status = Send(greeting); status != IoStatus::kOk) return status;
    }
    const auto prefix = protocol::FramePrefix(message.size());
    const std::array<asio::const_buffer, 2> buffers{asio::buffer(prefix),
                                                    asio::buffer(message.data(), message.size())};
    std::optional<asio::error_code> result;
    asio::async_write(socket_, buffers,
                      [&](const asio::error_code& error, std::size_t) { result = error; });
    const auto deadline = Clock::now() + send_timeout_;
    context_.restart();
    // The pending read may complete first; the loop goes on until the write has.
    while (!result && context_.run_one_until(deadline) > 0) {
    }
    if (!result) Close();  // part of a frame may have been sent, so no other frame can follow
    return *result ? IoStatus::kClosed : IoStatus::kOk;
  }

  IoStatus Receive(std::span<const std::uint8_t>& message,
                   std::chrono::milliseconds timeout) override {
    const auto deadline = Clock::now() + timeout;
    if (!connected()) {
      const bool done = connect_result_ || AwaitConnect(deadline);
      return done && *connect_result_ ? IoStatus::kNoConnection : IoStatus::kTimeout;
    }
    for (;;) {
      if (!unread_.empty()) {
        switch (frames_.Push(unread_, message)) {
          case protocol::FrameStatus::kFrame: return IoStatus::kOk;
          case protocol::FrameStatus::kBadLength:
            unread_ = {};
            Close();
            return IoStatus::kMalformed;
          case protocol::FrameStatus::kNeedMore: break;
        }
      }
      pump_.Start(socket_, buffer_);
      // After a timeout the read stays pending and keeps using buffer_, which therefore belongs to
      // the transport.
      if (!pump_.Wait(context_, deadline)) return IoStatus::kTimeout;
      if (pump_.error()) return IoStatus::kClosed;
      unread_ = std::span<const std::uint8_t>(buffer_).first(pump_.bytes());
    }
  }

 private:
  // Returns false if the connect has neither succeeded nor failed at the deadline.
  bool AwaitConnect(Clock::time_point deadline) {
    context_.restart();
    while (!connect_result_ && context_.run_one_until(deadline) > 0) {
    }
    // With a deadline in the past nothing has run yet.
    if (!connect_result_) context_.poll();
    return connect_result_.has_value();
  }

  // Runs the pending handlers to their end, because they refer to variables of the caller's frame.
  void Close() {
    asio::error_code ignored;
    socket_.close(ignored);
    context_.restart();
    context_.run();
  }

  std::chrono::milliseconds send_timeout_;
  std::vector<std::uint8_t> greeting_;  // sent before everything else
  asio::io_context context_{1};
  tcp::socket socket_{context_};
  std::optional<asio::error_code> connect_result_;  // nothing: not known yet
  ReadPump pump_;
  std::vector<std::uint8_t> buffer_ = std::vector<std::uint8_t>(64 * 1024);
  std::span<const std::uint8_t> unread_;
  protocol::FrameReader frames_{protocol::kMaxReplyBytes};
};

class UdpTransport : public Transport {
 public:
  UdpTransport() : Transport(TransportKind::kUdp) {}

  asio::error_code Connect(const std::string& host, std::uint16_t port) {
    return socket_.Connect(host, port);
  }

  IoStatus Send(std::span<const std::uint8_t> message) override {
    if (message.size() > protocol::kMaxUdpMessageBytes) return IoStatus::kTooLarge;
    const std::size_t count = protocol::NumDatagrams(message.size());
    const std::uint32_t id = next_message_id_++;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t bytes = protocol::WriteDatagram(message, id, i, datagram_);
      const IoStatus status = socket_.Send(std::span(datagram_).first(bytes));
      if (status != IoStatus::kOk) return status;
    }
    return IoStatus::kOk;
  }

  IoStatus Receive(std::span<const std::uint8_t>& message,
                   std::chrono::milliseconds timeout) override {
    constexpr int kMaxPieces = 1024;  // a flood of fragments must not outlast the timeout
    const auto deadline = Clock::now() + timeout;
    (void)reassembler_.Expire(Microseconds(Clock::now()));
    for (int piece = 0; piece < kMaxPieces; ++piece) {
      if (unbundler_.Next(message)) return IoStatus::kOk;
      std::span<std::uint8_t> datagram;
      const IoStatus read = socket_.Receive(deadline, datagram);
      if (read != IoStatus::kOk) return read;
      switch (reassembler_.Push(0, datagram, Microseconds(Clock::now()), message)) {
        case protocol::FragmentStatus::kWhole: (void)unbundler_.Open(datagram); break;
        case protocol::FragmentStatus::kComplete: return IoStatus::kOk;
        default: break;  // an incomplete message or a foreign datagram
      }
    }
    return IoStatus::kTimeout;
  }

  [[nodiscard]] bool takes_bundles() const override { return true; }

 private:
  DatagramSocket socket_;
  std::array<std::uint8_t, protocol::kMaxDatagramBytes> datagram_{};
  protocol::Unbundler unbundler_;  // splits the last datagram
  protocol::Reassembler reassembler_;
  std::uint32_t next_message_id_ = 0;
};

}  // namespace

Result<std::unique_ptr<Transport>> OpenTransport(TransportKind kind, const std::string& host,
                                                 std::uint16_t port,
                                                 std::chrono::milliseconds timeout,
                                                 const Token* token) {
  if (kind == TransportKind::kUdp && token != nullptr) {
    auto transport = std::make_unique<SecureTransport>(*token);
    const asio::error_code code = transport->Connect(host, port);
    if (code) return ConnectionFailed(kind, host, port, code.message());
    if (transport->Await(Clock::now() + timeout))
      return std::unique_ptr<Transport>(std::move(transport));
    if (transport->refusal() == protocol::secure::Refusal::kNone) {
      return ConnectionFailed(kind, host, port, transport->failure());
    }
    return Status(StatusCode::kInvalidArgument, transport->failure(), AddressText(host, port));
  }
  if (kind == TransportKind::kUdp) return BeginTransport(kind, host, port, timeout);
  auto transport = std::make_unique<TcpTransport>(timeout, token);
  const asio::error_code code = transport->Connect(host, port, Clock::now() + timeout);
  if (code) return ConnectionFailed(kind, host, port, code.message());
  return std::unique_ptr<Transport>(std::move(transport));
}

Result<std::unique_ptr<Transport>> BeginTransport(TransportKind kind, const std::string& host,
                                                  std::uint16_t port,
                                                  std::chrono::milliseconds send_timeout,
                                                  const Token* token) {
  asio::error_code code;
  std::unique_ptr<Transport> result;
  if (kind == TransportKind::kUdp && token != nullptr) {
    auto transport = std::make_unique<SecureTransport>(*token);
    code = transport->Connect(host, port);
    result = std::move(transport);
  } else if (kind == TransportKind::kTcp) {
    auto transport = std::make_unique<TcpTransport>(send_timeout, token);
    code = transport->Begin(host, port);
    result = std::move(transport);
  } else {
    auto transport = std::make_unique<UdpTransport>();
    code = transport->Connect(host, port);
    result = std::move(transport);
  }
  if (code) return ConnectionFailed(kind, host, port, code.message());
  return result;
}

}  // namespace furrow::client

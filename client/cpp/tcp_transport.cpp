// SPDX-License-Identifier: Apache-2.0
#include "client/cpp/tcp_transport.h"

#include <algorithm>
#include <utility>

#include <asio/buffer.hpp>
#include <asio/connect.hpp>
#include <asio/ssl/error.hpp>
#include <asio/write.hpp>

#include "client/cpp/connect_error.h"
#include "client/cpp/tls/client_tls.h"

namespace furrow::client {
namespace {

using asio::ip::tcp;

bool IsLoopback(const asio::ip::address& address) {
  if (!address.is_v6()) return address.is_loopback();
  const auto v6 = address.to_v6();
  return v6.is_v4_mapped() ? asio::ip::make_address_v4(asio::ip::v4_mapped, v6).is_loopback()
                           : v6.is_loopback();
}

// OpenSSL's code of an error; 0: it comes from the socket.
unsigned long TlsCode(const asio::error_code& error) {
  return error.category() == asio::error::get_ssl_category()
             ? static_cast<unsigned long>(error.value())
             : 0;
}

}  // namespace

TcpTransport::TcpTransport(std::chrono::milliseconds send_timeout, Security security)
    : Transport(TransportKind::kTcp), send_timeout_(send_timeout), security_(std::move(security)) {
  if (security_.token) greeting_ = TokenGreeting(*security_.token);
}

Status TcpTransport::Begin(const std::string& host, std::uint16_t port) {
  host_ = host;
  port_ = port;
  asio::error_code error;
  tcp::resolver resolver(context_);
  const auto endpoints = resolver.resolve(host, std::to_string(port), error);
  if (error) return ConnectError(kind(), host, port, error);
  const bool in_clear = security_.token && security_.tls == nullptr && !security_.token_in_clear;
  const bool leaves = std::any_of(endpoints.begin(), endpoints.end(), [](const auto& entry) {
    return !IsLoopback(entry.endpoint().address());
  });
  if (in_clear && leaves) {
    return {StatusCode::kInvalidArgument,
            "the token would travel to " + AddressText(host, port) + " unencrypted", "",
            "use UDP, or TLS (tls=1, --tls); token-in-clear=1 and --token-in-clear send it anyway"};
  }
  asio::async_connect(
      stream_.lower(), endpoints,
      [this](const asio::error_code& result, const tcp::endpoint&) { OnConnected(result); });
  return {};
}

void TcpTransport::OnConnected(const asio::error_code& error) {
  if (error) return Fail(error.message());
  asio::error_code ignored;
  stream_.lower().set_option(tcp::no_delay(true), ignored);
  if (security_.tls == nullptr) return Finish({});
  SSL* const ssl = NewTlsClient(security_.tls.get(), host_);
  if (ssl == nullptr) return FailTls("TLS cannot check the name " + host_);
  stream_.AddUpper(ssl);  // takes the SSL object over
  stream_.upper()->async_handshake(asio::ssl::stream_base::client,
                                   [this](const asio::error_code& result) { OnHandshake(result); });
}

void TcpTransport::OnHandshake(const asio::error_code& error) {
  if (!error) return Finish({});
  // A peer that objects to something sends an alert, which is an error of OpenSSL.
  handshake_cut_ = TlsCode(error) == 0;
  if (handshake_cut_) return Finish(HandshakeCut(host_, port_, /*is_closed=*/true));
  FailTls("no connection to " + AddressText(host_, port_) +
          " over TLS: " + TlsFailureText(stream_.upper()->native_handle(), TlsCode(error)));
}

void TcpTransport::FailTls(std::string reason) {
  tls_failed_ = true;
  Finish({StatusCode::kInvalidArgument, std::move(reason)});
}

void TcpTransport::Finish(Status result) {
  failure_ = result.what();
  result_ = std::move(result);
}

void TcpTransport::Fail(const std::string& reason) {
  Finish(ConnectionFailed(kind(), host_, port_, reason));
  failure_ = reason;
}

Status TcpTransport::Await(Clock::time_point deadline) {
  if (!AwaitConnect(deadline)) {
    const bool shakes = shakes_hands();
    Close();
    handshake_cut_ = false;  // this end has closed it
    if (shakes) {
      Finish(HandshakeCut(host_, port_, /*is_closed=*/false));
    } else {
      Fail(asio::error_code(asio::error::timed_out).message());
    }
  }
  return *result_;
}

std::string TcpTransport::failure() const {
  return shakes_hands() ? HandshakeCut(host_, port_, /*is_closed=*/false).what() : failure_;
}

std::chrono::microseconds TcpTransport::connect_timeout() const {
  return shakes_hands() ? kTlsConnectTimeout : Transport::connect_timeout();
}

IoStatus TcpTransport::Send(std::span<const std::uint8_t> message) {
  if (message.size() > protocol::kMaxRequestBytes) return IoStatus::kTooLarge;
  if (!connected()) return IoStatus::kNoConnection;
  if (!greeting_.empty()) {
    const auto greeting = std::exchange(greeting_, {});
    if (const IoStatus status = Send(greeting); status != IoStatus::kOk) return status;
  }
  // One buffer, so that the prefix does not become a TLS record of its own.
  const auto prefix = protocol::FramePrefix(message.size());
  frame_.assign(prefix.begin(), prefix.end());
  frame_.insert(frame_.end(), message.begin(), message.end());
  std::optional<asio::error_code> result;
  asio::async_write(stream_, asio::buffer(frame_),
                    [&](const asio::error_code& error, std::size_t) { result = error; });
  const auto deadline = Clock::now() + send_timeout_;
  context_.restart();
  // The pending read may complete first; the loop goes on until the write has.
  while (!result && context_.run_one_until(deadline) > 0) {
  }
  if (!result) Close();  // part of a frame may have been sent, so no other frame can follow
  return *result ? IoStatus::kClosed : IoStatus::kOk;
}

IoStatus TcpTransport::Receive(std::span<const std::uint8_t>& message,
                               std::chrono::milliseconds timeout) {
  const auto deadline = Clock::now() + timeout;
  if (!connected()) {
    const bool done = result_ || AwaitConnect(deadline);
    return done && !result_->ok() ? IoStatus::kNoConnection : IoStatus::kTimeout;
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
    StartRead();
    // After a timeout the read stays pending and keeps using buffer_, which therefore belongs to
    // the transport.
    if (!AwaitRead(deadline)) return IoStatus::kTimeout;
    if (read_error_) return OnReadError();
    unread_ = std::span<const std::uint8_t>(buffer_).first(read_bytes_);
  }
}

// A daemon that refuses the certificate of a client says so after the handshake.
IoStatus TcpTransport::OnReadError() {
  if (const unsigned long code = TlsCode(read_error_); code != 0) {
    failure_ = TlsFailureText(stream_.upper()->native_handle(), code);
    tls_failed_ = true;
  }
  return IoStatus::kClosed;
}

void TcpTransport::StartRead() {
  // Send() runs the context too, so a completed read may still wait to be taken.
  if (read_pending_ || read_done_) return;
  read_pending_ = true;
  stream_.async_read_some(asio::buffer(buffer_),
                          [this](const asio::error_code& error, std::size_t bytes) {
                            read_pending_ = false;
                            read_done_ = true;
                            read_error_ = error;
                            read_bytes_ = bytes;
                          });
}

// Runs handlers until `done()` or the deadline; over TLS, one read takes several.
template <class Done>
void TcpTransport::RunUntil(Clock::time_point deadline, const Done& done) {
  if (done()) return;
  // A context without work stops, and a stopped context runs nothing.
  context_.restart();
  while (!done() && context_.run_one_until(deadline) > 0) {
  }
  // With a deadline in the past nothing has run yet, although data may be waiting.
  if (!done()) context_.poll();
}

// Returns true when the read has completed.
bool TcpTransport::AwaitRead(Clock::time_point deadline) {
  RunUntil(deadline, [this] { return read_done_; });
  return std::exchange(read_done_, false);
}

// Returns false if the connect has neither succeeded nor failed at the deadline.
bool TcpTransport::AwaitConnect(Clock::time_point deadline) {
  RunUntil(deadline, [this] { return result_.has_value(); });
  return result_.has_value();
}

// Runs the pending handlers to their end, because they refer to variables of the caller's frame.
void TcpTransport::Close() {
  asio::error_code ignored;
  stream_.lower().close(ignored);
  context_.restart();
  context_.run();
}

}  // namespace furrow::client

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>

#include "server/net/socket_watch.h"
#include "server/tls/handshake.h"
#include "server/tls/tls_connection.h"

namespace furrow::server {

// The server's end of TLS over a TCP socket, as Asio's reads and writes take a stream
// (AsyncStream). Unlike asio::ssl::stream, it has no buffers: while it waits, it holds what OpenSSL
// holds. `Net`: see Door.
//
// One read, one write, and one handshake or end may be pending at a time. Starting an operation
// never calls its handler directly. Operations end when the socket closes. The socket and the
// stream must outlive their operations.
template <class Net>
class TlsStream {
 public:
  using Socket = typename Net::Tcp::socket;
  using executor_type = typename Socket::executor_type;
  using Error = typename Net::Error;
  using Clock = std::chrono::steady_clock;

  // Throws std::bad_alloc.
  TlsStream(Socket& socket, SSL_CTX* context) : socket_(socket), tls_(context) {}
  TlsStream(const TlsStream&) = delete;
  TlsStream& operator=(const TlsStream&) = delete;

  [[nodiscard]] executor_type get_executor() { return socket_.get_executor(); }

  // Operations that begin from now on and have not ended then close the socket, and fail with
  // ETIMEDOUT. Clock::time_point::max(): never.
  void expires_at(Clock::time_point time) { expires_at_ = time; }

  // Call it when the client has shown who it is; see TlsConnection.
  void SetTrusting() { tls_.SetTrusting(Number()); }
  [[nodiscard]] bool has_client_certificate() const { return tls_.has_client_certificate(); }

  // Fails after kMostHandshakeTime at the latest, also if nobody watches the socket.
  template <class Token>
  auto async_handshake(Token&& token) {
    return Start<void(Error)>([this] { return tls_.Handshake(Number()); },
                              std::forward<Token>(token),
                              std::min(expires_at_, Clock::now() + kMostHandshakeTime));
  }
  // See TlsConnection::End().
  template <class Token>
  auto async_end(bool awaits_client, Token&& token) {
    return Start<void(Error)>([this, awaits_client] { return tls_.End(Number(), awaits_client); },
                              std::forward<Token>(token));
  }
  template <class Buffers, class Token>
  auto async_read_some(const Buffers& buffers, Token&& token) {
    return Start<void(Error, std::size_t)>(
        [this, bytes = First(buffers)] {
          return bytes.empty() ? Outcome() : tls_.Read(Number(), bytes);
        },
        std::forward<Token>(token));
  }
  // Small buffers leave together in one record.
  template <class Buffers, class Token>
  auto async_write_some(const Buffers& buffers, Token&& token) {
    return Start<void(Error, std::size_t)>([this, buffers] { return Write(buffers); },
                                           std::forward<Token>(token));
  }

 private:
  using Timer = typename Net::Timer;
  using Outcome = TlsConnection::Outcome;
  using Progress = TlsConnection::Progress;
  // See Progress::kNeedsTime.
  static constexpr auto kPause = std::chrono::milliseconds(20);
  // A second more than StrangerWatch gives, which counts why a handshake failed.
  static constexpr auto kMostHandshakeTime = kHandshakeDeadline + std::chrono::seconds(1);

  // Calls `step` until it needs nothing more.
  template <class Step, bool kHasSize>
  struct Operation {
    TlsStream* stream;
    Step step;
    Clock::time_point expires_at;
    Outcome outcome = {};
    bool is_over = false;
    bool has_waited = false;
    std::unique_ptr<SocketWatch<Timer, Socket>> watch = {};  // if it expires
    std::unique_ptr<Timer> pause = {};

    template <class Self>
    void operator()(Self& self, Error error = {}) {
      if (!is_over && !error) {
        outcome = step();
        if (Waits()) return Wait(self);
        error = stream->ErrorOf(outcome);
      } else if (is_over) {
        error = stream->ErrorOf(outcome);
      }
      if (watch != nullptr && watch->expired()) error = Net::SystemError(ETIMEDOUT);
      if (!has_waited) {  // not by the function that begins the operation
        is_over = has_waited = true;
        auto executor = stream->get_executor();
        return Net::Post(executor, std::move(self));
      }
      const std::size_t size = error ? 0 : outcome.size;
      watch.reset();
      pause.reset();
      if constexpr (kHasSize) {
        self.complete(error, size);
      } else {
        self.complete(error);
      }
    }

    [[nodiscard]] bool Waits() const {
      return outcome.progress == Progress::kNeedsInput ||
             outcome.progress == Progress::kNeedsOutput || outcome.progress == Progress::kNeedsTime;
    }

    // `self` contains this object, which moves into the handler.
    template <class Self>
    void Wait(Self& self) {
      has_waited = true;
      Socket& socket = stream->socket_;
      if (watch == nullptr && expires_at != Clock::time_point::max()) {
        watch = std::make_unique<SocketWatch<Timer, Socket>>(socket, expires_at);
      }
      if (outcome.progress == Progress::kNeedsTime) {
        if (pause == nullptr) pause = std::make_unique<Timer>(socket.get_executor());
        Timer& timer = *pause;
        timer.expires_after(kPause);
        return timer.async_wait(std::move(self));
      }
      socket.async_wait(
          outcome.progress == Progress::kNeedsInput ? Socket::wait_read : Socket::wait_write,
          std::move(self));
    }
  };

  template <class Signature, class Step, class Token>
  auto Start(Step step, Token&& token) {
    return Start<Signature>(std::move(step), std::forward<Token>(token), expires_at_);
  }
  template <class Signature, class Step, class Token>
  auto Start(Step step, Token&& token, Clock::time_point expires_at) {
    constexpr bool kHasSize = std::is_same_v<Signature, void(Error, std::size_t)>;
    return Net::template Compose<Signature>(
        Operation<Step, kHasSize>{this, std::move(step), expires_at}, std::forward<Token>(token),
        socket_);
  }

  [[nodiscard]] static Error ErrorOf(const Outcome& outcome) {
    switch (outcome.progress) {
      case Progress::kEnded: return Net::Ended();
      case Progress::kTruncated: return Net::Truncated();
      case Progress::kFailed: return Net::TlsError(outcome.code);
      case Progress::kBroken: return Net::SystemError(static_cast<int>(outcome.code));
      default: return {};
    }
  }

  // The number of the socket; -1: it is closed.
  [[nodiscard]] int Number() { return socket_.is_open() ? socket_.native_handle() : -1; }

  // The first buffer that is not empty.
  template <class Buffers>
  [[nodiscard]] static std::span<std::uint8_t> First(const Buffers& buffers) {
    const auto end = Net::End(buffers);
    for (auto each = Net::Begin(buffers); each != end; ++each) {
      const auto buffer = Net::Mutable(*each);
      if (buffer.size() > 0) return {static_cast<std::uint8_t*>(buffer.data()), buffer.size()};
    }
    return {};
  }

  // Writes the beginning of the buffers, of the same bytes each time. They move together into a
  // buffer of the thread, unless the first one fills a record or is the only one.
  template <class Buffers>
  [[nodiscard]] Outcome Write(const Buffers& buffers) {
    static thread_local std::array<std::uint8_t, TlsConnection::kRecordBytes> together;
    std::span<const std::uint8_t> first;
    std::size_t size = 0;  // of `together`
    const auto end = Net::End(buffers);
    for (auto each = Net::Begin(buffers); each != end; ++each) {
      const auto buffer = Net::Const(*each);
      if (buffer.size() == 0) continue;
      const std::span bytes(static_cast<const std::uint8_t*>(buffer.data()), buffer.size());
      if (first.empty()) {
        first = bytes;
        if (first.size() >= together.size()) break;
        continue;
      }
      if (size == 0) size = Append(first, 0, together);
      size = Append(bytes, size, together);
      if (size == together.size()) break;
    }
    if (first.empty()) return {};
    return tls_.Write(Number(),
                      size > 0 ? std::span<const std::uint8_t>(together).first(size) : first);
  }
  static std::size_t Append(std::span<const std::uint8_t> bytes, std::size_t size,
                            std::span<std::uint8_t> to) {
    const std::size_t count = std::min(bytes.size(), to.size() - size);
    std::memcpy(to.data() + size, bytes.data(), count);
    return size + count;
  }

  Socket& socket_;
  TlsConnection tls_;
  Clock::time_point expires_at_ = Clock::time_point::max();
};

}  // namespace furrow::server

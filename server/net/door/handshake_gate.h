// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <coroutine>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "server/core/metrics.h"
#include "server/net/clock.h"
#include "server/tls/handshake.h"
#include "server/tls/handshake_places.h"
#include "server/tls/handshake_watch.h"
#include "server/tls/tls_context.h"

namespace furrow::server {

// Begins TLS on connections of a port that speaks nothing else: within kHandshakeDeadline, within
// the budget of each host, and on a bounded number at a time. Counts what fails, by reason. `Net`:
// see Door. Belongs to the thread of its connections.
template <class Net>
class HandshakeGate {
 public:
  using Socket = typename Net::Tcp::socket;

  struct Parts {
    Metrics* metrics = nullptr;           // not null; outlives the gate
    std::function<TlsContext()> context;  // the present one, asked for each handshake
    // Sends a client that speaks without TLS one answer, and the end.
    std::function<void(Socket& socket)> answer_plain;
  };
  explicit HandshakeGate(Parts parts) : parts_(std::move(parts)) {}
  HandshakeGate(const HandshakeGate&) = delete;
  HandshakeGate& operator=(const HandshakeGate&) = delete;

  // True: TLS has begun. False: the connection must close. `stream`: a StreamSocket or WebStream;
  // it and `host` outlive the coroutine.
  template <class Stream>
  [[nodiscard]] typename Net::template Awaitable<bool> Pass(Stream& stream,
                                                            const std::string& host) {
    Socket& socket = stream.socket();
    const HandshakeWatch<Timer, Socket> watch(socket);
    Error error;
    co_await socket.async_wait(Socket::wait_read, Net::Redirect(error));
    std::optional<bool> is_tls;
    if (!error) is_tls = SpeaksTls(socket);
    if (!is_tls) {  // it has closed, or waited too long
      if (watch.expired()) parts_.metrics->Add(Counter::kTlsSlow);
      co_return false;
    }
    if (!*is_tls) {
      parts_.metrics->Add(Counter::kTlsPlain);
      parts_.answer_plain(socket);
      co_await AwaitEnd(socket);
      co_return false;
    }
    if (!budget_.Take(host, ReadClock())) {
      parts_.metrics->Add(Counter::kTlsBusy);
      co_return false;
    }
    // The watch ends the wait, too.
    HandshakePlaces::Place place;
    Timer timer(socket.get_executor());
    while (!watch.expired() && (place = places_.Enter(host)) == nullptr) {
      timer.expires_after(HandshakePlaces::kPoll);
      Error ignored;
      co_await timer.async_wait(Net::Redirect(ignored));
    }
    error = co_await stream.Handshake(parts_.context());
    place.reset();
    if (error) {
      parts_.metrics->Add(watch.expired()
                              ? Counter::kTlsSlow
                              : HandshakeFailure(static_cast<unsigned long>(error.value())));
      co_return false;
    }
    parts_.metrics->Add(Counter::kTlsHandshakes);
    co_return true;
  }

 private:
  using Timer = typename Net::Timer;
  using Error = typename Net::Error;

  // Looks at the first bytes, which stay in the socket. Nothing: the client has closed.
  [[nodiscard]] static std::optional<bool> SpeaksTls(Socket& socket) {
    std::array<std::uint8_t, kTlsPrefixBytes> first{};
    Error error;
    socket.non_blocking(true, error);
    std::size_t size = 0;
    if (!error) size = socket.receive(Net::Buffer(first), Socket::message_peek, error);
    if (error) return std::nullopt;
    return LooksLikeTls(std::span(first).first(size));
  }

  // Waits until the client has closed: closing with unread input would reset the connection and
  // lose the answer. HandshakeWatch limits the time.
  static typename Net::template Awaitable<void> AwaitEnd(Socket& socket) {
    std::array<char, 1024> dropped;
    Error error;
    while (!error) co_await socket.async_read_some(Net::Buffer(dropped), Net::Redirect(error));
  }

  const Parts parts_;
  HandshakeBudget budget_;
  HandshakePlaces places_;
};

}  // namespace furrow::server

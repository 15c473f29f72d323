// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <coroutine>
#include <functional>
#include <map>
#include <memory>
#include <new>
#include <string>
#include <utility>

#include "server/core/metrics.h"
#include "server/net/clock.h"
#include "server/net/door/bare_sockets.h"
#include "server/net/door/stranger_watch.h"
#include "server/tls/handshake.h"
#include "server/tls/handshake_places.h"
#include "server/tls/tls_context.h"

namespace furrow::server {

// Begins TLS on connections of a port that speaks nothing else. Each handshake has the time
// kHandshakeDeadline and counts against the budget of its host. A connection waits as a bare socket
// (BareSockets) until its host has a place for a stranger. Failures are counted by reason. `Net`:
// see Door. Belongs to the thread of its connections.
template <class Net>
class HandshakeGate {
 public:
  using Socket = typename Net::Tcp::socket;
  using Place = std::unique_ptr<HandshakePlaces::Place>;

  struct Parts {
    Metrics* metrics = nullptr;               // not null; outlives the gate
    const HandshakePlaces* places = nullptr;  // outlives the gate; null: nobody enters the gate
    std::function<TlsContext()> context;      // the present one, asked for each handshake
    // Sends a client that speaks without TLS one answer, and the end.
    std::function<void(Socket& socket)> answer_plain;
    // Begins a connection, which calls Pass().
    std::function<void(Socket socket, const std::string& host, Place place)> begin;
    // A connection of the host has ended without begin(), or because begin() lacked memory.
    std::function<void(const std::string& host)> ended;
    std::function<Time()> clock = &ReadClock;  // the present time
    HandshakeBudget budget;
  };
  // `loop`: outlives the gate.
  HandshakeGate(typename Net::Loop& loop, Parts parts)
      : loop_(loop), timer_(loop), parts_(std::move(parts)) {}
  HandshakeGate(const HandshakeGate&) = delete;
  HandshakeGate& operator=(const HandshakeGate&) = delete;

  // The connection waits until its handshake can begin. After std::bad_alloc it is closed, without
  // a call of ended().
  void Enter(Socket socket, const std::string& host) {
    if (!is_looking_) LookLater();
    Error error;
    sockets_.Add(host, socket.native_handle(), parts_.clock());
    socket.release(error);
  }
  // Closes all that wait, without calls of ended().
  void Close() { sockets_.Close(); }

  // True: TLS has begun, and the stream holds the place until its Admit(). False: the connection
  // must close. `stream`: a StreamSocket or WebStream, which outlives the coroutine.
  template <class Stream>
  [[nodiscard]] typename Net::template Awaitable<bool> Pass(Stream& stream, Place place) {
    const auto watch = std::make_shared<StrangerWatch<Timer, Socket>>(
        stream.socket(), std::move(place), parts_.metrics, parts_.clock);
    const Error error = co_await stream.Handshake(parts_.context());
    if (error) {
      parts_.metrics->Add(watch->expired()
                              ? Counter::kTlsSlow
                              : HandshakeFailure(static_cast<unsigned long>(error.value())));
      co_return false;
    }
    parts_.metrics->Add(Counter::kTlsHandshakes);
    watch->EndHandshake();
    stream.Hold(watch);
    co_return true;
  }

  // How often the gate looks at the sockets that wait.
  static constexpr auto kPoll = std::chrono::milliseconds(2);

 private:
  using Timer = typename Net::Timer;
  using Error = typename Net::Error;

  void LookLater() {
    is_looking_ = false;  // also after std::bad_alloc; the next connection tries again
    timer_.expires_after(kPoll);
    timer_.async_wait([this](const Error& cancelled) {
      if (cancelled) return;
      try {
        const Time now = parts_.clock();
        LookAtSockets(now);
        BeginThoseWithAPlace(now);
      } catch (const std::bad_alloc&) {
        parts_.metrics->Add(Counter::kAllocationsFailed);
        waiting_.clear();  // nobody must give way to those who have gone
      }
      is_looking_ = false;
      if (!sockets_.empty()) LookLaterOrEnd();
    });
    is_looking_ = true;
  }

  // Nobody would look at the sockets if LookLater() failed.
  void LookLaterOrEnd() {
    try {
      LookLater();
    } catch (const std::bad_alloc&) {
      parts_.metrics->Add(Counter::kAllocationsFailed);
      waiting_.clear();
      sockets_.Close(parts_.ended);
    }
  }

  void LookAtSockets(Time now) {
    for (const auto& [host, socket, kind] : sockets_.Look(now)) {
      switch (kind) {
        case BareSockets::Kind::kPlain:
          parts_.metrics->Add(Counter::kTlsPlain);
          AnswerPlain(socket);
          continue;
        case BareSockets::Kind::kSlow: parts_.metrics->Add(Counter::kTlsSlow); break;
        case BareSockets::Kind::kBusy: parts_.metrics->Add(Counter::kTlsBusy); break;
        case BareSockets::Kind::kGone: break;
      }
      sockets_.Remove(host, socket);
      parts_.ended(host);
    }
  }

  // The number of the socket belongs to `sockets_`, which waits for the end of the client: closing
  // with unread input would reset the connection and lose the answer.
  void AnswerPlain(int number) {
    Socket socket(loop_);
    Error error;
    // Both protocols are the same to a socket that is connected.
    socket.assign(Net::Tcp::v4(), number, error);
    if (error) return;
    try {
      socket.non_blocking(true, error);
      parts_.answer_plain(socket);
    } catch (const std::bad_alloc&) {
      parts_.metrics->Add(Counter::kAllocationsFailed);
    }
    socket.release(error);
  }

  void BeginThoseWithAPlace(Time now) {
    std::map<std::string, HandshakePlaces::Waiting> waiting;
    for (const std::string& host : sockets_.HostsThatWait()) {
      Place place = parts_.places->Enter(host);
      if (place == nullptr) {
        const auto known = waiting_.find(host);
        waiting[host] = known != waiting_.end() ? known->second : parts_.places->Wait(host);
        continue;
      }
      Begin(sockets_.Take(host), host, std::move(place), now);
    }
    waiting_ = std::move(waiting);
  }

  // Takes over the socket with this number.
  void Begin(int number, const std::string& host, Place place, Time now) {
    Socket socket(loop_);
    bool begins = false;
    try {
      Error error;
      socket.assign(Net::Tcp::v4(), number, error);
      begins = !error && parts_.budget.Take(host, now);
      if (begins) return parts_.begin(std::move(socket), host, std::move(place));
      if (!error) parts_.metrics->Add(Counter::kTlsBusy);
    } catch (const std::bad_alloc&) {
      parts_.metrics->Add(Counter::kAllocationsFailed);
    }
    if (!begins && !socket.is_open()) BareSockets::CloseSocket(number);
    parts_.ended(host);
  }

  typename Net::Loop& loop_;
  Timer timer_;
  Parts parts_;
  BareSockets sockets_;
  std::map<std::string, HandshakePlaces::Waiting> waiting_;  // by host
  bool is_looking_ = false;                                  // LookLater() goes on
};

}  // namespace furrow::server

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <new>
#include <utility>

#include "server/core/metrics.h"
#include "server/net/clock.h"
#include "server/net/door/tcp_progress.h"
#include "server/tls/handshake.h"
#include "server/tls/handshake_places.h"
#include "server/tls/stranger_patience.h"

namespace furrow::server {

// Holds the place of a stranger's connection until it ends or the client has shown who it is.
class Stranger {
 public:
  virtual ~Stranger() = default;
  // Others wait for the place; see HandshakePlaces.
  [[nodiscard]] virtual bool IsWanted() const = 0;
  // A whole request has arrived, and the client has time to receive the reply.
  virtual void NoteRequest() = 0;
};

// Closes the socket of a stranger whose handshake takes longer than kHandshakeDeadline, or that
// keeps a place which others want (StrangerPatience). For the sockets and timers of both Asios:
// standalone and Boost. The socket must outlive the watch.
template <class Timer, class Socket>
class StrangerWatch : public Stranger {
 public:
  using Clock = std::function<Time()>;

  // `metrics`: not null; outlives the watch; counts strangers that give way after the handshake.
  // `clock`: the present time.
  StrangerWatch(Socket& socket, std::unique_ptr<HandshakePlaces::Place> place, Metrics* metrics,
                Clock clock = &ReadClock)
      : shared_(std::make_shared<Shared>(socket, std::move(place), metrics, std::move(clock))) {
    shared_->Wait(shared_);
  }
  ~StrangerWatch() override { shared_->End(); }
  StrangerWatch(const StrangerWatch&) = delete;
  StrangerWatch& operator=(const StrangerWatch&) = delete;

  // The handshake is over, and its deadline does not count any more.
  void EndHandshake() {
    shared_->in_handshake = false;
    NoteRequest();
  }
  void NoteRequest() override { shared_->patience.Restart(shared_->clock()); }
  // The watch has closed the socket.
  [[nodiscard]] bool expired() const { return shared_->expired; }
  [[nodiscard]] bool IsWanted() const override { return shared_->place->IsWanted(); }

 private:
  static constexpr auto kInterval = std::chrono::milliseconds(50);

  struct Shared {
    Shared(Socket& watched, std::unique_ptr<HandshakePlaces::Place> held, Metrics* counts,
           Clock time)
        : clock(std::move(time)),
          socket(&watched),
          place(std::move(held)),
          metrics(counts),
          timer(watched.get_executor()) {}

    // The timer holds this object, also after the end of the watch.
    void Wait(const std::shared_ptr<Shared>& self) {
      timer.expires_after(kInterval);
      timer.async_wait([self](const auto& cancelled) {
        if (cancelled || self->socket == nullptr) return;
        try {
          if (!self->IsOver(self->clock())) return self->Wait(self);
        } catch (const std::bad_alloc&) {  // a stranger that nobody watches must not stay
          self->metrics->Add(Counter::kAllocationsFailed);
        }
        self->expired = true;
        if (!self->in_handshake) self->metrics->Add(Counter::kConnectionsGaveWay);
        auto ignored = cancelled;
        self->socket->close(ignored);
      });
    }
    [[nodiscard]] bool IsOver(Time now) {
      if (!socket->is_open()) return false;
      const StrangerPatience::Client client = ReadTcpProgress(socket->native_handle());
      if (patience.IsOver(now, client, place->IsWanted())) return true;
      return in_handshake && now - begun >= kHandshakeDeadline;
    }
    void End() {
      socket = nullptr;
      place.reset();
      timer.cancel();
    }

    const Clock clock;
    Socket* socket;  // null after the end of the watch
    std::unique_ptr<HandshakePlaces::Place> place;
    Metrics* const metrics;
    Timer timer;
    const Time begun = clock();
    StrangerPatience patience{begun};
    bool in_handshake = true;
    bool expired = false;
  };
  const std::shared_ptr<Shared> shared_;
};

}  // namespace furrow::server

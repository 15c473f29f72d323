// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <utility>

#include "server/core/metrics.h"
#include "server/net/clock.h"
#include "server/net/door/received_bytes.h"
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
};

// Closes the socket of a stranger whose handshake takes longer than kHandshakeDeadline, or that
// keeps a place which others want (StrangerPatience). For the sockets and timers of both Asios:
// standalone and Boost. The socket must outlive the watch.
template <class Timer, class Socket>
class StrangerWatch : public Stranger {
 public:
  // `metrics`: not null; outlives the watch; counts strangers that give way after the handshake.
  StrangerWatch(Socket& socket, std::unique_ptr<HandshakePlaces::Place> place, Metrics* metrics)
      : shared_(std::make_shared<Shared>(socket, std::move(place), metrics)) {
    shared_->Wait(shared_);
  }
  ~StrangerWatch() override { shared_->End(); }
  StrangerWatch(const StrangerWatch&) = delete;
  StrangerWatch& operator=(const StrangerWatch&) = delete;

  // The handshake is over, and its deadline does not count any more.
  void EndHandshake() {
    shared_->in_handshake = false;
    shared_->patience.Restart(ReadClock());
  }
  // The watch has closed the socket.
  [[nodiscard]] bool expired() const { return shared_->expired; }
  [[nodiscard]] bool IsWanted() const override { return shared_->place->IsWanted(); }

 private:
  static constexpr auto kInterval = std::chrono::milliseconds(50);

  struct Shared {
    Shared(Socket& watched, std::unique_ptr<HandshakePlaces::Place> held, Metrics* counts)
        : socket(&watched),
          place(std::move(held)),
          metrics(counts),
          timer(watched.get_executor()) {}

    // The timer holds this object, also after the end of the watch.
    void Wait(const std::shared_ptr<Shared>& self) {
      timer.expires_after(kInterval);
      timer.async_wait([self](const auto& cancelled) {
        if (cancelled || self->socket == nullptr) return;
        if (!self->IsOver(ReadClock())) return self->Wait(self);
        self->expired = true;
        if (!self->in_handshake) self->metrics->Add(Counter::kConnectionsGaveWay);
        auto ignored = cancelled;
        self->socket->close(ignored);
      });
    }
    [[nodiscard]] bool IsOver(Time now) {
      if (!socket->is_open()) return false;
      const bool is_wanted = place->IsWanted();
      const std::uint64_t received = is_wanted ? ReceivedByPeer(socket->native_handle()) : 0;
      if (patience.IsOver(now, received, is_wanted)) return true;
      return in_handshake && now - begun >= kHandshakeDeadline;
    }
    void End() {
      socket = nullptr;
      place.reset();
      timer.cancel();
    }

    Socket* socket;  // null after the end of the watch
    std::unique_ptr<HandshakePlaces::Place> place;
    Metrics* const metrics;
    Timer timer;
    const Time begun = ReadClock();
    StrangerPatience patience{begun};
    bool in_handshake = true;
    bool expired = false;
  };
  const std::shared_ptr<Shared> shared_;
};

}  // namespace furrow::server

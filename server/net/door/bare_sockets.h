// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "server/core/time.h"

namespace furrow::server {

// The connections of a port that speaks TLS, until their handshakes begin: bare sockets, which take
// 12 bytes each. What a client has sent stays in the kernel. So a client that is silent, or sends
// half of its first message, costs the daemon next to nothing.
class BareSockets {
 public:
  BareSockets() = default;
  ~BareSockets() { Close(); }
  BareSockets(const BareSockets&) = delete;
  BareSockets& operator=(const BareSockets&) = delete;

  // Longer than a stranger may keep the place that others wait for (StrangerPatience).
  static constexpr Time kPlaceDeadline = std::chrono::seconds(12);

  // Takes over a socket, unless it throws std::bad_alloc.
  void Add(const std::string& host, int socket, Time now);
  [[nodiscard]] bool empty() const { return hosts_.empty(); }

  enum class Kind {
    kPlain,  // it does not speak TLS: answer it; once it has closed, it is kGone
    kGone,   // it has closed: remove it, as after all that follows
    kSlow,   // it has not spoken within kHandshakeDeadline
    kBusy,   // it has spoken, but has not found a place within kPlaceDeadline
  };
  struct Event {
    std::string host;
    int socket = -1;
    Kind kind = Kind::kGone;
  };
  // Looks at all sockets. Call it every few milliseconds unless empty().
  [[nodiscard]] std::vector<Event> Look(Time now);
  // Closes a socket of Look().
  void Remove(const std::string& host, int socket);

  // The hosts with a client whose first message has arrived as a whole. The list begins after the
  // host of the last Take(), so that each host gets its turn.
  [[nodiscard]] std::vector<std::string> HostsThatWait() const;
  // Gives the caller the socket of such a client: alternately the oldest and the newest, so that a
  // new client need not wait behind a long queue. Precondition: there is one.
  [[nodiscard]] int Take(const std::string& host);

  static void CloseSocket(int socket);
  // Closes all sockets.
  void Close() {
    Close([](const std::string&) {});
  }
  // The same, and calls `closed` with the host of each.
  template <class Closed>
  void Close(const Closed& closed) {
    for (const auto& [name, host] : hosts_) {
      for (const Arrival& each : host.arrivals) {
        CloseSocket(each.socket);
        closed(name);
      }
    }
    hosts_.clear();
  }

 private:
  enum class Stage : std::uint8_t { kSilent, kReady, kAnswered };
  // Small, because a host may have many. Its milliseconds may wrap around.
  struct Arrival {
    std::uint32_t came;
    int socket;
    std::uint16_t low_water;  // SO_RCVLOWAT
    Stage stage;
  };
  struct Host {
    std::vector<Arrival> arrivals;
    bool takes_last = false;  // the next Take()
  };
  // Looks at a socket that can be read. False: it waits on, or is ready.
  static bool Judge(Arrival* arrival, Kind* kind);

  std::map<std::string, Host> hosts_;  // none is empty
  std::string last_host_;              // of Take()
};

}  // namespace furrow::server

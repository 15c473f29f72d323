// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <span>

#include <sys/epoll.h>

#include "client/load/net/socket.h"

namespace furrow::load {

// Waits for many descriptors at once, to the microsecond.
class Poller {
 public:
  // How it waits: by epoll_pwait2(), or where the system has none (Linux before 5.11) by a ppoll()
  // on the set, as exact but two system calls. A poller finds that out by itself.
  enum class Calls { kOne, kTwo };

  static constexpr std::size_t kMost = 64;

  explicit Poller(Calls calls = Calls::kOne);

  // `token` comes back when the descriptor is readable or closed: as long as it is (kLevel), or
  // once whenever something comes in (kEdge).
  enum class When { kLevel, kEdge };
  void Add(int descriptor, std::uint64_t token, When when = When::kLevel);
  void Remove(int descriptor);

  // Waits at most `timeout_ns` (0: only looks). At most kMost events, the others next time; valid
  // until the next call. An interrupting signal gives none.
  [[nodiscard]] std::span<const epoll_event> Wait(std::int64_t timeout_ns);

 private:
  [[nodiscard]] int WaitByTwoCalls(const timespec& timeout);

  Descriptor epoll_;
  Calls calls_;
  std::array<epoll_event, kMost> events_{};
};

}  // namespace furrow::load

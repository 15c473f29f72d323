// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <sys/epoll.h>

#include "client/load/socket.h"

namespace furrow::load {

// Waits for many descriptors at once, to the microsecond.
class Poller {
 public:
  Poller();

  // `token` comes back when the descriptor is readable or closed.
  void Add(int descriptor, std::uint64_t token);
  void Remove(int descriptor);

  // Waits at most `timeout_ns` (0: only looks). The events are valid until the next call; an
  // interrupting signal gives none.
  [[nodiscard]] std::span<const epoll_event> Wait(std::int64_t timeout_ns);

 private:
  Descriptor epoll_;
  std::array<epoll_event, 64> events_{};
};

}  // namespace furrow::load

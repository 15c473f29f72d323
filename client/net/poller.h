// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <span>

#include <sys/epoll.h>

#include "base/process/descriptor.h"

namespace furrow::net {

// Waits for many descriptors at once, with a resolution of microseconds. Used by one thread.
class Poller {
 public:
  // kOne waits with epoll_pwait2(). kTwo is for Linux before 5.11, which lacks that call: it waits
  // with ppoll() on the epoll descriptor and then reads the events, which is as exact but takes two
  // system calls. A poller switches to kTwo by itself.
  enum class Calls { kOne, kTwo };

  static constexpr std::size_t kMaxEvents = 64;

  explicit Poller(Calls calls = Calls::kOne);

  // Wait() reports `token` when the descriptor is readable or closed: every time while that is so
  // (kLevel), or once per arrival of new data (kEdge).
  enum class When { kLevel, kEdge };
  // Starts waiting for `descriptor`, which must stay open until Remove().
  void Add(int descriptor, std::uint64_t token, When when = When::kLevel);
  void Remove(int descriptor);

  // Waits up to `timeout_ns` (0: does not wait) and returns at most kMaxEvents events; the next
  // call returns the others. The span is valid until the next call. It is empty after a signal.
  [[nodiscard]] std::span<const epoll_event> Wait(std::int64_t timeout_ns);

 private:
  [[nodiscard]] int WaitByTwoCalls(const timespec& timeout);

  Descriptor epoll_;
  Calls calls_;
  std::array<epoll_event, kMaxEvents> events_{};
};

}  // namespace furrow::net

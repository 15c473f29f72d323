// SPDX-License-Identifier: Apache-2.0
#include "client/load/poller.h"

#include <algorithm>
#include <ctime>

#include <sys/prctl.h>

namespace furrow::load {

// Without the slack, a wait may end 50 us late, as long as a whole round trip takes.
Poller::Poller() : epoll_(epoll_create1(EPOLL_CLOEXEC)) { prctl(PR_SET_TIMERSLACK, 1UL); }

void Poller::Add(int descriptor, std::uint64_t token) {
  epoll_event event{};
  event.events = EPOLLIN;
  event.data.u64 = token;
  epoll_ctl(epoll_.get(), EPOLL_CTL_ADD, descriptor, &event);
}

void Poller::Remove(int descriptor) { epoll_ctl(epoll_.get(), EPOLL_CTL_DEL, descriptor, nullptr); }

std::span<const epoll_event> Poller::Wait(std::int64_t timeout_ns) {
  timeout_ns = std::max<std::int64_t>(timeout_ns, 0);
  const timespec timeout{timeout_ns / 1'000'000'000, timeout_ns % 1'000'000'000};
  const int ready = epoll_pwait2(epoll_.get(), events_.data(), static_cast<int>(events_.size()),
                                 &timeout, nullptr);
  return std::span<const epoll_event>(events_).first(static_cast<std::size_t>(std::max(ready, 0)));
}

}  // namespace furrow::load

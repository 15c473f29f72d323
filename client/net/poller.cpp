// SPDX-License-Identifier: Apache-2.0
#include "client/net/poller.h"

#include <algorithm>
#include <cerrno>
#include <ctime>

#include <poll.h>
#include <sys/prctl.h>

namespace furrow::net {

// The default timer slack lets a wait end 50 us late, which is as long as a whole round trip.
Poller::Poller(Calls calls) : epoll_(epoll_create1(EPOLL_CLOEXEC)), calls_(calls) {
  prctl(PR_SET_TIMERSLACK, 1UL);
}

void Poller::Add(int descriptor, std::uint64_t token, When when) {
  epoll_event event{};
  event.events = EPOLLIN;
  if (when == When::kEdge) event.events |= EPOLLET;
  event.data.u64 = token;
  epoll_ctl(epoll_.get(), EPOLL_CTL_ADD, descriptor, &event);
}

void Poller::Remove(int descriptor) { epoll_ctl(epoll_.get(), EPOLL_CTL_DEL, descriptor, nullptr); }

std::span<const epoll_event> Poller::Wait(std::int64_t timeout_ns) {
  timeout_ns = std::max<std::int64_t>(timeout_ns, 0);
  const timespec timeout{timeout_ns / 1'000'000'000, timeout_ns % 1'000'000'000};
  int ready = -1;
  if (calls_ == Calls::kOne) {
    ready = epoll_pwait2(epoll_.get(), events_.data(), static_cast<int>(events_.size()), &timeout,
                         nullptr);
    // The kernel is asked once; glibc may know the call where the kernel does not.
    if (ready < 0 && errno == ENOSYS) calls_ = Calls::kTwo;
  }
  if (calls_ == Calls::kTwo) ready = WaitByTwoCalls(timeout);
  return std::span<const epoll_event>(events_).first(static_cast<std::size_t>(std::max(ready, 0)));
}

// An epoll descriptor is itself readable while one of its descriptors is.
int Poller::WaitByTwoCalls(const timespec& timeout) {
  pollfd set{epoll_.get(), POLLIN, 0};
  if (ppoll(&set, 1, &timeout, nullptr) <= 0) return 0;
  return epoll_wait(epoll_.get(), events_.data(), static_cast<int>(events_.size()), 0);
}

}  // namespace furrow::net

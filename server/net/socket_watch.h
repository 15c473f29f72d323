// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

namespace furrow::server {

// Closes a socket at a point in time, unless the watch has ended before. For the sockets and timers
// of both Asios: standalone and Boost. The socket must outlive the watch.
template <class Timer, class Socket>
class SocketWatch {
 public:
  SocketWatch(Socket& socket, typename Timer::time_point expires_at)
      : shared_(std::make_shared<Shared>(&socket)), timer_(socket.get_executor()) {
    timer_.expires_at(expires_at);
    timer_.async_wait([shared = shared_](const auto& cancelled) {
      if (cancelled || shared->socket == nullptr) return;
      shared->expired = true;
      auto ignored = cancelled;
      shared->socket->close(ignored);
    });
  }
  // The timer cancels itself, but may have queued its call already.
  ~SocketWatch() { shared_->socket = nullptr; }
  SocketWatch(const SocketWatch&) = delete;
  SocketWatch& operator=(const SocketWatch&) = delete;

  [[nodiscard]] bool expired() const { return shared_->expired; }

 private:
  struct Shared {
    explicit Shared(Socket* watched) : socket(watched) {}
    Socket* socket;  // null after the end of the watch
    bool expired = false;
  };
  std::shared_ptr<Shared> shared_;
  Timer timer_;
};

}  // namespace furrow::server

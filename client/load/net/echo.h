// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "base/status.h"

namespace furrow::load {

// The least that a UDP server can do, to measure others against: a process of its own that sends
// each datagram back as it came, one recvfrom() and one sendto() a datagram, on a free port of
// 127.0.0.1. It lives as long as this object, and no longer than the process that made it.
class EchoServer {
 public:
  // `same_cores_as`: the process beside which it is compared; it runs on that one's cores. Call it
  // where this process has no second thread: it forks.
  [[nodiscard]] static Result<EchoServer> Start(std::optional<int> same_cores_as);
  ~EchoServer();
  EchoServer(EchoServer&& other) noexcept;
  EchoServer& operator=(EchoServer&&) = delete;

  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] int pid() const { return pid_; }

 private:
  EchoServer(int pid, std::uint16_t port) : pid_(pid), port_(port) {}

  int pid_;
  std::uint16_t port_;
};

}  // namespace furrow::load

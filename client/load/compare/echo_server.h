// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "base/status.h"

namespace furrow::load {

// A minimal UDP server as a baseline for measurements: a child process that returns every datagram
// with one recvfrom() and one sendto(), on a free port of 127.0.0.1. The process ends with this
// object or with the process that created it.
class EchoServer {
 public:
  // Starts the process on the same cores as process `same_cores_as`. It forks, so call it while
  // this process has a single thread. Errors: kIo.
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

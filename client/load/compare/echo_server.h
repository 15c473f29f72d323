// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "base/status.h"

namespace furrow::load {

// A minimal UDP server, the baseline of comparisons: a child process that returns every datagram
// with one recvfrom() and one sendto(), on a free port of 127.0.0.1. The child ends when this
// object is destroyed or when the process that created it ends.
class EchoServer {
 public:
  // Starts the child process. `same_cores_as`: the process (pid) whose CPU affinity it copies;
  // empty: that of this process. It forks, so call it while this process has a single thread.
  // Errors: kIo.
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

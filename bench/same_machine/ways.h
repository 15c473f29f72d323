// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace furrow::bench {

// A way for messages from the daemon to a client on the same machine. The objects are made before
// the client's process is forked; each process then uses its own half.
class Way {
 public:
  virtual ~Way() = default;
  // The first calls of each half, after the fork.
  virtual void StartReader() {}
  virtual void StartWriter() {}
  // Sends one message and wakes a sleeping reader.
  virtual void Send(std::span<const std::uint8_t> message) = 0;
  // Returns the next message, or an empty span if none arrives within `timeout_ms` (0: does not
  // wait). The message is valid until the next call.
  [[nodiscard]] virtual std::span<const std::uint8_t> Receive(int timeout_ms) = 0;
  // Skips to the newest message, as a reader that polls does. False: nothing to skip, read all.
  virtual bool SkipToNewest() { return false; }
};

// Sends as the daemon does (UdpSender); receives through the client library's transport, or by bare
// system calls, the least that UDP can cost.
[[nodiscard]] std::unique_ptr<Way> UdpLibrary();
[[nodiscard]] std::unique_ptr<Way> UdpBare();
// A ring in shared memory. A reader sleeps on a futex, or waits with poll() for an eventfd beside a
// socket, as a client needs that also listens to the daemon. kNobody: never wakes, for readers that
// poll.
enum class Wake { kFutex, kEventfd, kNobody };
[[nodiscard]] std::unique_ptr<Way> SharedRing(Wake wake);
// Sends and receives nothing: what keeping time costs the two processes.
[[nodiscard]] std::unique_ptr<Way> Nothing();

}  // namespace furrow::bench

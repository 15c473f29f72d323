// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include <sys/socket.h>

namespace furrow::net {

// Converts the kernel's arrival time stamps of datagrams to the clock of SteadyNanoseconds().
//
// A load tester sends and reads on one thread. Kernel time stamps keep the time that a datagram
// waits in the receive buffer out of the measured latency of the server.
//
// The kernel stamps with the wall clock, which may be set during a run. The first batch that is
// read after such a step counts as having arrived when it was read.
class ArrivalClock {
 public:
  // Asks the kernel to stamp the datagrams of a socket. The stamps arrive as control messages.
  static void Enable(int socket);

  // Reads both clocks. Call it after each batch is read from the socket.
  void Read();
  // Does the work of Read() with the given clock values, nanoseconds; for tests.
  void Set(std::int64_t steady_ns, std::int64_t wall_ns);

  // Arrival time of one datagram of the batch, nanoseconds of SteadyNanoseconds(); `header` as
  // recvmmsg() filled it. Without a time stamp this is the time at which the batch was read.
  [[nodiscard]] std::int64_t Arrival(msghdr* header) const;
  // Converts a time of the wall clock to the clock of SteadyNanoseconds(), nanoseconds.
  [[nodiscard]] std::int64_t FromWall(std::int64_t wall_ns) const;

 private:
  std::int64_t steady_ns_ = 0;
  std::int64_t wall_ns_ = 0;
  std::optional<std::int64_t> ahead_ns_;  // wall clock minus steady clock
  bool was_set_ = false;                  // the wall clock was set since the previous batch
};

}  // namespace furrow::net

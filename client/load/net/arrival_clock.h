// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include <sys/socket.h>

namespace furrow::load {

// When datagrams came in, on the clock of SteadyNanoseconds(), from the stamps that the system puts
// on them. So what this program did while one lay in its socket (it sends and reads on one thread)
// is no part of a server's latency.
//
// The stamps are of the clock on the wall, which may be set in the midst of a run: those that were
// read since it was set are not believed once, and count as having come when they were read.
class ArrivalClock {
 public:
  // Has the system stamp what comes to a socket; the stamps are in its control messages.
  static void Enable(int socket);

  // Reads both clocks. To be called after each batch was taken from the socket.
  void Read();
  // The same with what the clocks say.
  void Set(std::int64_t steady_ns, std::int64_t wall_ns);

  // When a datagram of the batch came; `header` as recvmmsg() filled it. Where there is no stamp,
  // when the batch was read.
  [[nodiscard]] std::int64_t Arrival(msghdr* header) const;
  [[nodiscard]] std::int64_t FromWall(std::int64_t wall_ns) const;

 private:
  std::int64_t steady_ns_ = 0;
  std::int64_t wall_ns_ = 0;
  std::optional<std::int64_t> ahead_ns_;  // by how much the wall's clock is
  bool was_set_ = false;                  // since the batch before
};

}  // namespace furrow::load

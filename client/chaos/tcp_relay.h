// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "base/process/descriptor.h"
#include "client/chaos/link.h"

namespace furrow::chaos {

// Counts of the traffic in one direction of TCP connections.
struct RelayCounts {
  std::uint64_t connections = 0;
  std::uint64_t bytes = 0;    // forwarded
  std::uint64_t held = 0;     // number of reads that jitter held back
  std::int64_t still_us = 0;  // total time that connections were stalled by black holes

  void Add(const RelayCounts& other);
};

// One TCP connection through the proxy. TCP never loses or reorders bytes, so the relay only delays
// them: by jitter, and by stalling in a black hole. It buffers up to 64 KiB per direction in
// addition to the system's buffers.
class TcpRelay {
 public:
  // `client`, `server`: connected sockets. `up`: faults from client to server; `down`: back.
  // `number` makes links with the same seed differ. `start_us`: time 0 of the black holes, on the
  // clock of Pump().
  TcpRelay(Descriptor client, Descriptor server, const Faults& up, const Faults& down,
           std::uint64_t number, std::int64_t start_us);

  // Forwards what is due, without blocking. Returns false when the connection has ended. `now_us`:
  // microseconds of a monotonic clock.
  [[nodiscard]] bool Pump(std::int64_t now_us);

  // Time of the next Pump() if no data arrives; -1: none is needed. Call it after Pump().
  [[nodiscard]] std::int64_t next_us(std::int64_t now_us) const;
  // Descriptors to wait for, edge-triggered: Pump() reads until no data is left, or next_us() tells
  // when it continues.
  [[nodiscard]] int client() const { return client_.get(); }
  [[nodiscard]] int server() const { return server_.get(); }

  [[nodiscard]] const RelayCounts& up_counts() const { return up_.counts; }
  [[nodiscard]] const RelayCounts& down_counts() const { return down_.counts; }

 private:
  struct Direction {
    Faults options;
    std::mt19937_64 random;
    std::vector<std::uint8_t> bytes;  // read and not yet written
    std::size_t written = 0;
    std::int64_t due_us = 0;
    bool drained = false;              // the last read found no data
    std::int64_t still_since_us = -1;  // start of the stall; -1: not stalled
    RelayCounts counts;
  };

  [[nodiscard]] bool Move(Direction& direction, int from, int to, std::int64_t now_us);
  [[nodiscard]] bool StandsStill(Direction& direction, std::int64_t now_us) const;
  [[nodiscard]] static std::int64_t NextUs(const Direction& direction, std::int64_t now_us);

  Descriptor client_;
  Descriptor server_;
  Direction up_;
  Direction down_;
  std::int64_t start_us_;
};

}  // namespace furrow::chaos

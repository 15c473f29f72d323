// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "client/chaos/link.h"
#include "client/load/net/socket.h"

namespace furrow::load {

// What was done to the bytes of one direction of TCP connections.
struct ChaosStreamCounts {
  std::uint64_t connections = 0;
  std::uint64_t bytes = 0;    // that passed
  std::uint64_t held = 0;     // how often some were held back by jitter
  std::int64_t still_us = 0;  // for how long connections stood still in black holes, together

  void Add(const ChaosStreamCounts& other);
};

// One TCP connection through the proxy. Bytes are never lost or reordered, since TCP's are not:
// they are held back by jitter and stand still in a black hole, up to 64 KiB a direction here and
// what the system's buffers take.
class ChaosStream {
 public:
  // `start_us`: what black holes count from.
  ChaosStream(Descriptor client, Descriptor server, const ChaosOptions& up,
              const ChaosOptions& down, std::uint64_t number, std::int64_t start_us);

  // Moves what may move, without waiting. False: the connection has ended, on both sides.
  [[nodiscard]] bool Pump(std::int64_t now_us);

  // When to call Pump() again though nothing comes in; -1: only then. Asked after a Pump().
  [[nodiscard]] std::int64_t next_us(std::int64_t now_us) const;
  // What to wait at: Pump() reads until nothing is left, or next_us() says when it goes on.
  [[nodiscard]] int client() const { return client_.get(); }
  [[nodiscard]] int server() const { return server_.get(); }

  [[nodiscard]] const ChaosStreamCounts& up_counts() const { return up_.counts; }
  [[nodiscard]] const ChaosStreamCounts& down_counts() const { return down_.counts; }

 private:
  struct Direction {
    ChaosOptions options;
    std::mt19937_64 random;
    std::vector<std::uint8_t> bytes;  // read, not yet written
    std::size_t written = 0;
    std::int64_t due_us = 0;
    bool drained = false;              // nothing was left to read
    std::int64_t still_since_us = -1;  // in a black hole
    ChaosStreamCounts counts;
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

}  // namespace furrow::load

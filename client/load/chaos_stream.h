// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "client/load/chaos_link.h"
#include "client/load/socket.h"

namespace furrow::load {

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

 private:
  struct Direction {
    ChaosOptions options;
    std::mt19937_64 random;
    std::vector<std::uint8_t> bytes;  // read, not yet written
    std::size_t written = 0;
    std::int64_t due_us = 0;
  };

  [[nodiscard]] bool Move(Direction& direction, int from, int to, std::int64_t now_us);

  Descriptor client_;
  Descriptor server_;
  Direction up_;
  Direction down_;
  std::int64_t start_us_;
};

}  // namespace furrow::load

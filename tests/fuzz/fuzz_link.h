// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "server/session/peers/peer.h"

namespace furrow::fuzz {

// A peer's connection that drops what the hub sends.
class QuietLink : public server::Link {
 public:
  void SendReply(std::span<const std::uint8_t>) override {}
  int SendFrame(std::uint64_t, std::span<const std::uint8_t>, std::size_t, int) override {
    return 0;
  }
  void DropFrames(std::uint64_t) override {}
};

}  // namespace furrow::fuzz

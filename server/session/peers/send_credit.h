// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace furrow::server {

// Keeps a datagram with a forged source address from turning the daemon into an amplifier: until an
// address has proved that it hears us, it gets at most as many bytes as it sent.
class SendCredit {
 public:
  void Received(std::uint64_t bytes) { received_ += bytes; }
  void Prove() { proven_ = true; }
  [[nodiscard]] bool proven() const { return proven_; }

  // True when `bytes` may go out now; they are then counted as sent, while that matters.
  [[nodiscard]] bool Spend(std::uint64_t bytes) {
    if (proven_) return true;  // and nothing is counted: several threads may ask
    if (sent_ + bytes > received_) return false;
    sent_ += bytes;
    return true;
  }

 private:
  std::uint64_t received_ = 0;
  std::uint64_t sent_ = 0;
  bool proven_ = false;
};

}  // namespace furrow::server

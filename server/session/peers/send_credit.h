// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace furrow::server {

// Limits the bytes that the daemon sends to a UDP address, which prevents amplification attacks
// with forged source addresses: until the address has proved that it receives messages, the daemon
// sends at most as many bytes to it as it has received from it.
class SendCredit {
 public:
  // Adds credit for bytes that arrived from the address.
  void Received(std::uint64_t bytes) { received_ += bytes; }
  // The address is proven: sending is unlimited from now on.
  void Prove() { proven_ = true; }
  [[nodiscard]] bool proven() const { return proven_; }

  // Spends credit for `bytes`. False: there is not enough.
  [[nodiscard]] bool Spend(std::uint64_t bytes) {
    if (proven_) return true;  // without a write: several threads may call this
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

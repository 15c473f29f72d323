// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace furrow::server {

// Prevents amplification attacks with forged source addresses: until a UDP address has proved that
// it receives our messages, it is sent at most as many bytes as it has sent.
class SendCredit {
 public:
  void Received(std::uint64_t bytes) { received_ += bytes; }
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

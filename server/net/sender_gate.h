// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>
#include <span>
#include <vector>

#include <asio/ip/address.hpp>

#include "server/core/time.h"

namespace furrow::server {

// Decides which sender may use a motion-capture port. Most foreign protocols neither authenticate
// nor identify the sender, so two senders at once would mix into one performance. The first sender
// with valid datagrams therefore holds the port until it has sent nothing for kRelease. Senders are
// distinguished by address, not by port, because they may change ports at any time.
class SenderGate {
 public:
  static constexpr Time kRelease = std::chrono::seconds(3);

  // kOne: one sender at a time. kAllAllowed: all allowed senders at once, for wires that identify
  // their senders.
  enum class Policy { kOne, kAllAllowed };

  // `allowed`: the addresses that may send; empty: any address, and the policy is then kOne.
  SenderGate(std::span<const asio::ip::address> allowed, Policy policy);

  // True if a datagram from this address may be read.
  [[nodiscard]] bool Admits(const asio::ip::address& sender, Time now) const;
  // True if this sender would replace another one, whose state must be discarded first.
  [[nodiscard]] bool IsSuccessor(const asio::ip::address& sender) const;
  // Call after a valid datagram of an admitted sender, which then holds the port. True if it did
  // not hold the port before. With kAllAllowed, nobody holds the port.
  bool Hold(const asio::ip::address& sender, Time now);

 private:
  std::vector<asio::ip::address> allowed_;
  bool exclusive_;
  std::optional<asio::ip::address> holder_;
  Time heard_{0};
};

}  // namespace furrow::server

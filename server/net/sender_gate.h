// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>
#include <span>
#include <vector>

#include <asio/ip/address.hpp>

#include "server/core/time.h"

namespace furrow::server {

// Who may feed a port of a foreign wire. Such wires prove nothing and most name nobody, so that two
// senders at once would mix into one performance: the first whose datagrams make sense has the port
// until it has been silent for kRelease. Addresses count without their ports, which senders change
// as they like.
class SenderGate {
 public:
  static constexpr Time kRelease = std::chrono::seconds(3);

  // How many senders a port takes at a time.
  enum class Holds { kOne, kEveryAllowed };

  // `allowed`: nobody else passes; empty: anybody may. kEveryAllowed is for wires that tell their
  // senders apart, and needs a list: without one it is kOne.
  SenderGate(std::span<const asio::ip::address> allowed, Holds holds);

  // Whether a datagram from there is to be read at all.
  [[nodiscard]] bool Admits(const asio::ip::address& sender, Time now) const;
  // Whether, once held, the port has changed hands: what the last sender said counts no more.
  [[nodiscard]] bool IsSuccessor(const asio::ip::address& sender) const;
  // A datagram that was admitted made sense: its sender has the port, or keeps it. True when it did
  // not have it before. Where everybody allowed passes, nobody has it.
  bool Hold(const asio::ip::address& sender, Time now);

 private:
  std::vector<asio::ip::address> allowed_;
  bool exclusive_;
  std::optional<asio::ip::address> holder_;
  Time heard_{0};
};

}  // namespace furrow::server

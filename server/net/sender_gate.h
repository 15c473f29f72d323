// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <asio/ip/address.hpp>

#include "server/core/time.h"

namespace furrow::server {

// One form per address: a dual-stack socket shows IPv4 addresses as ::ffff:a.b.c.d.
[[nodiscard]] asio::ip::address Plain(const asio::ip::address& address);

// Decides which sender may use a motion-capture port. Most foreign protocols neither authenticate
// nor identify the sender, so two senders at once would mix into one performance. The first sender
// that sends steadily therefore holds the port until it has sent nothing for kRelease. A single
// datagram from a forged address takes nothing from anybody. Senders are distinguished by address,
// not by port, because they may change ports at any time.
class SenderGate {
 public:
  static constexpr Time kRelease = std::chrono::seconds(3);
  // Valid datagrams that make a sender hold the port.
  static constexpr int kSteady = 8;

  // kOne: one sender at a time. kAllAllowed: all allowed senders at once, for wires that identify
  // their senders.
  enum class Policy { kOne, kAllAllowed };

  // `allowed`: the addresses that may send; empty: any address, and the policy is then kOne.
  SenderGate(std::span<const asio::ip::address> allowed, Policy policy);

  // Counts a datagram from this address. True if it may be read: its sender holds the port, or
  // nobody does and no other sender has sent more.
  [[nodiscard]] bool Admits(const asio::ip::address& sender, Time now);
  // True if the datagrams before came from another sender, whose state must be discarded first.
  [[nodiscard]] bool IsSuccessor(const asio::ip::address& sender) const;
  // Call after a valid datagram of an admitted sender. True if it holds the port from now on and
  // did not before. With kAllAllowed, nobody holds the port.
  bool Hold(const asio::ip::address& sender, Time now);
  // The sender that holds the port; nothing: nobody does, or the policy is kAllAllowed.
  [[nodiscard]] std::optional<asio::ip::address> HolderAt(Time now) const;
  // Makes this sender hold the port at once, whoever holds it now. It loses the port after
  // kRelease if it sends nothing. With kAllAllowed, nothing changes. False: it is not allowed.
  [[nodiscard]] bool Give(const asio::ip::address& sender, Time now);
  // Call after an invalid datagram of an admitted sender, for example a port scan.
  void Discard(const asio::ip::address& sender);

 private:
  // A sender that sends while nobody holds the port.
  struct Candidate {
    asio::ip::address address;
    int datagrams = 0;
    Time last{0};
  };
  static constexpr std::size_t kMaxCandidates = 1024;

  [[nodiscard]] bool IsAllowed(const asio::ip::address& plain) const;
  Candidate& Count(const asio::ip::address& sender, Time now);
  [[nodiscard]] bool IsHeld(Time now) const { return holder_ && now - heard_ <= kRelease; }

  std::vector<asio::ip::address> allowed_;
  bool exclusive_;
  std::optional<asio::ip::address> holder_;  // also after its claim has ended
  Time heard_{0};
  std::optional<asio::ip::address> read_;  // the sender of the last valid datagram
  std::vector<Candidate> candidates_;      // in order of arrival
};

}  // namespace furrow::server

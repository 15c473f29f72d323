// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "protocol/secure/crypto/primitives.h"
#include "protocol/secure/handshake/peer_address.h"

namespace furrow::protocol::secure {

inline constexpr std::size_t kCookieBytes = 24;
using Cookie = std::array<std::uint8_t, kCookieBytes>;
using CookieView = std::span<const std::uint8_t, kCookieBytes>;

// Makes and checks address cookies: who returns one receives at that address. The maker keeps two
// keys and nothing for each address. A cookie is its time slot (u64) and a keyed hash of BLAKE2b
// with 128 bits over purpose, address, port, `context` and slot.
class CookieMaker {
 public:
  // Of one slot. A cookie is valid in its slot and the next one, so for 60 to 120 s.
  static constexpr std::int64_t kSlotMicroseconds = 60'000'000;

  // What the cookie proves, so that one kind never passes for the other.
  enum class Purpose : std::uint8_t { kInitiation = 1, kPath = 2 };
  static constexpr std::size_t kContextBytes = 24;
  using Context = std::span<const std::uint8_t, kContextBytes>;

  // Keeps a reference to `random`, which gives the key of each slot.
  explicit CookieMaker(RandomSource& random) : random_(random) {}

  // `now_us`: on any clock that never runs backwards, at least 0.
  [[nodiscard]] Cookie Make(Purpose purpose, const PeerAddress& address, Context context,
                            std::int64_t now_us);
  [[nodiscard]] bool Check(CookieView cookie, Purpose purpose, const PeerAddress& address,
                           Context context, std::int64_t now_us);

 private:
  void TurnTo(std::uint64_t slot);
  [[nodiscard]] Cookie Compute(std::uint64_t slot, Purpose purpose, const PeerAddress& address,
                               Context context) const;

  RandomSource& random_;
  bool started_ = false;
  std::uint64_t slot_ = 0;
  Key current_;
  Key previous_;  // of slot_ - 1
};

}  // namespace furrow::protocol::secure

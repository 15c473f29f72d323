// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/secure/handshake/peer_address.h"
#include "protocol/secure/session/now.h"
#include "protocol/secure/token/connect_token.h"
#include "protocol/secure/token/key_ring.h"

namespace furrow::protocol::secure::test {

using Bytes = std::vector<std::uint8_t>;

// Random numbers that repeat from one run to the next (splitmix64).
class RepeatableRandom : public RandomSource {
 public:
  explicit RepeatableRandom(std::uint64_t seed = 1) : state_(seed) {}

  void Fill(std::span<std::uint8_t> bytes) override {
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(Next() >> 32);
  }
  std::uint64_t Next() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ULL);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }
  [[nodiscard]] std::uint64_t Below(std::uint64_t limit) { return Next() % limit; }

 private:
  std::uint64_t state_;
};

inline int DigitOf(char c) { return c <= '9' ? c - '0' : c - 'a' + 10; }

inline Bytes FromHex(std::string_view text) {
  Bytes bytes;
  for (std::size_t i = 0; i + 1 < text.size(); i += 2) {
    bytes.push_back(static_cast<std::uint8_t>(DigitOf(text[i]) * 16 + DigitOf(text[i + 1])));
  }
  return bytes;
}

inline std::string ToHex(std::span<const std::uint8_t> bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes) {
    for (const int digit : {byte >> 4, byte & 15}) text += "0123456789abcdef"[digit];
  }
  return text;
}

inline Key KeyFromHex(std::string_view text) {
  const Bytes bytes = FromHex(text);
  return Key(std::span(bytes).first<kKeyBytes>());
}

inline std::string ToHex(const Key& key) { return ToHex(key.bytes()); }

inline constexpr std::uint64_t kUnixNow = 1'800'000'000;
inline constexpr Now kNow{1'000'000'000, kUnixNow};

inline Now Later(Now now, std::int64_t us) {
  return {now.us + us, now.unix_s + static_cast<std::uint64_t>(us / 1'000'000)};
}

// A ring with one key, valid for 30 days from kUnixNow.
inline KeyRing MakeRing(RandomSource& random) {
  KeyRing ring;
  (void)ring.AddNew(kUnixNow, kUnixNow + 30 * 86'400, random);
  return ring;
}

inline Grant WatchGrant() {
  Grant grant;
  grant.client_id = 77;
  grant.roles = Role::kWatch;
  grant.subjects = "stage-*";
  return grant;
}

// A token of the ring's newest key that is valid for an hour.
inline ClientToken MakeTestToken(const KeyRing& ring, RandomSource& random,
                                 const Grant& grant = WatchGrant(),
                                 std::uint64_t expires = kUnixNow + 3'600) {
  const TokenKey* const key = ring.Newest(kUnixNow);
  return *MakeToken(key->id, key->key, expires, grant, random);
}

inline const PeerAddress kHome = FromIpv4({192, 0, 2, 1}, 5'000);
inline const PeerAddress kSameHost = FromIpv4({192, 0, 2, 1}, 5'001);
inline const PeerAddress kAway = FromIpv4({198, 51, 100, 7}, 5'000);

}  // namespace furrow::protocol::secure::test

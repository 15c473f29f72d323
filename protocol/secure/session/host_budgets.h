// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "protocol/secure/crypto/primitives.h"
#include "protocol/secure/handshake/peer_address.h"
#include "protocol/secure/session/rate_budget.h"

namespace furrow::protocol::secure {

// A rate budget for each token at each host, in a table of fixed size, so that no number of them
// costs more memory. Those that share a place share its budget. Nobody outside can choose one that
// shares the place of another one, because the place is a keyed hash. All IPv6 addresses of a /64
// network are one host. Such a network is often that of a whole building, and its clients must not
// be locked out by a neighbour, so the host alone does not count.
class HostBudgets {
 public:
  static constexpr std::size_t kPlaces = 1024;

  HostBudgets(std::uint32_t per_second, RandomSource& random)
      : key_(random.MakeKey()), places_(kPlaces, RateBudget(per_second)) {}

  // Takes one event from the budget of the token at the host. False, without effect, if it is used
  // up. `token`: of a token whose seal is right; others could be invented without end.
  [[nodiscard]] bool Take(const PeerAddress& from, const TokenNonce& token, std::int64_t now_us) {
    return places_[PlaceOf(from, token)].Take(now_us);
  }

 private:
  [[nodiscard]] std::size_t PlaceOf(const PeerAddress& from, const TokenNonce& token) const {
    static constexpr std::array<std::uint8_t, 12> kMapped = {0, 0, 0, 0, 0,   0,
                                                             0, 0, 0, 0, 255, 255};
    const bool is_v4 = std::equal(kMapped.begin(), kMapped.end(), from.host.begin());
    std::array<std::uint8_t, 16 + kTokenNonceBytes> input{};
    std::copy_n(from.host.begin(), is_v4 ? 16 : 8, input.begin());
    std::copy(token.begin(), token.end(), input.begin() + 16);
    const Mac hash = Blake2b128(key_, input);
    return (hash[0] | hash[1] << 8) % kPlaces;
  }

  Key key_;
  std::vector<RateBudget> places_;
};

}  // namespace furrow::protocol::secure

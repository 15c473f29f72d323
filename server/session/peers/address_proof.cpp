// SPDX-License-Identifier: Apache-2.0
#include "server/session/peers/address_proof.h"

#include <algorithm>
#include <cstring>

#include "protocol/secure/crypto/primitives.h"

namespace furrow::server {
namespace {

std::int64_t SlotOf(Time now) { return now / AddressProof::kSlot; }

}  // namespace

AddressProof::AddressProof(const Key& key) : key_(key) {}

std::uint64_t AddressProof::Hash(const UdpAddress& address, std::uint64_t session,
                                 std::int64_t slot) const {
  std::array<std::uint8_t, sizeof(UdpAddress) + sizeof(session) + sizeof(slot)> input;
  std::ranges::copy(address, input.begin());
  std::memcpy(&input[sizeof(UdpAddress)], &session, sizeof(session));
  std::memcpy(&input[sizeof(UdpAddress) + sizeof(session)], &slot, sizeof(slot));
  const protocol::secure::Mac mac = protocol::secure::Blake2b128(key_, input);
  std::uint64_t token = 0;
  std::memcpy(&token, mac.data(), sizeof(token));
  return token;
}

std::uint64_t AddressProof::Token(const UdpAddress& address, std::uint64_t session,
                                  Time now) const {
  // On the wire, 0 means that there is no token.
  return std::max<std::uint64_t>(1, Hash(address, session, SlotOf(now)));
}

bool AddressProof::Check(const UdpAddress& address, std::uint64_t session, std::uint64_t token,
                         Time now) const {
  const auto made_in = [&](std::int64_t slot) {
    return token == std::max<std::uint64_t>(1, Hash(address, session, slot));
  };
  // A token of the slot before may have been made a moment ago.
  return token != 0 && (made_in(SlotOf(now)) || made_in(SlotOf(now) - 1));
}

}  // namespace furrow::server

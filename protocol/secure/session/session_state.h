// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "protocol/secure/crypto/primitives.h"
#include "protocol/secure/handshake/peer_address.h"
#include "protocol/secure/packet/packet_opener.h"
#include "protocol/secure/packet/packet_sealer.h"
#include "protocol/secure/token/connect_token.h"

namespace furrow::protocol::secure {

// A session of SecureServer on its way to another process on the same machine, which shares its
// clock. It holds the keys of the session.
struct SessionState {
  std::uint32_t index = 0;  // at the server
  PacketSealer::State sealer;
  PacketOpener::State opener;
  Hash handshake_hash{};
  PeerAddress address;  // of the client
  Grant grant;
  std::uint64_t expires = 0;  // Unix time in seconds
  PublicKey client_key{};
  TokenNonce token_nonce{};
  std::uint32_t key_id = 0;
  std::array<std::uint8_t, 16> token_host{};
  std::int64_t last_heard_us = 0;
};

}  // namespace furrow::protocol::secure

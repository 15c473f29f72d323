// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "protocol/codec/codec.h"
#include "server/core/metrics.h"
#include "server/core/time.h"
#include "server/session/peers/address_proof.h"
#include "server/shares/token_bucket.h"

namespace furrow::server {

// Meets UDP senders that are not peers yet: addresses that have not proved that they receive what
// is sent to them, and programs that use the address of a peer without knowing its session number
// (STANDARD.md section 4). Remembers nothing about them, and never answers with more bytes than it
// received.
class Reception {
 public:
  // `proof`, `metrics`: not null; outlive this object. `session`: of the daemon. `requires_token`:
  // nobody is admitted, because clients with a token seal their datagrams.
  Reception(std::uint64_t session, const AddressProof* proof, Metrics* metrics,
            bool requires_token = false)
      : session_(session), proof_(proof), metrics_(metrics), requires_token_(requires_token) {}

  // Handles one datagram with a valid envelope. True: it proves the address, so the caller adds a
  // peer and gives it the datagram. False: the sender stays a stranger, and reply() holds the
  // answer. `has_peer`: the address belongs to a peer with another session, which must not be told
  // that its address is not proven because somebody forged a datagram.
  [[nodiscard]] bool Admits(const UdpAddress& address, bool has_peer,
                            std::span<const std::uint8_t> datagram, Time now);
  // Answers a datagram that Admits() has admitted, but for which the daemon has no place.
  void RefuseForLimit(std::span<const std::uint8_t> datagram);
  // The answer to the last datagram, one message; empty: none.
  [[nodiscard]] std::span<const std::uint8_t> reply() const { return reply_; }

 private:
  void Refuse(std::span<const std::uint8_t> datagram, protocol::ErrorCode code, const char* text);

  const std::uint64_t session_;
  const AddressProof* const proof_;
  Metrics* const metrics_;
  const bool requires_token_;
  TokenBucket refusals_{2000.0, 2000.0};  // of all strangers
  protocol::Encoder encoder_;
  protocol::Hello hello_;
  std::vector<std::uint8_t> reply_;
};

}  // namespace furrow::server

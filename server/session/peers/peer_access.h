// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <utility>

#include "server/core/limits.h"
#include "server/session/access/access.h"
#include "server/session/peers/peer.h"

namespace furrow::server {

// Sets what a peer may do. A token may also lower the rate at which its holder may send; the burst
// shrinks with it.
inline void Permit(Peer& peer, Access access, const Limits& limits) {
  const double most = access.packets_per_second();
  const double share = most > 0.0 ? std::min(1.0, most / limits.packets_per_second) : 1.0;
  // Not while the share stays the same: a full bucket for each token would be a way around it.
  if (share != peer.rate_share) {
    peer.rate_share = share;
    peer.bucket =
        TokenBucket(limits.packets_per_second * share, std::max(1.0, limits.packet_burst * share));
  }
  peer.access = std::move(access);
}

}  // namespace furrow::server

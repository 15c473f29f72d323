// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "server/core/network_address.h"
#include "server/session/peers/peer.h"

namespace furrow::server {

// The label of a peer at a network address: "udp 127.0.0.1 port 50112", with the host that the
// address counts to. `address`: numeric.
inline PeerLabel LabelOf(const std::string& transport, const std::string& address,
                         std::uint16_t port) {
  PeerLabel label(transport + " " + address + " port " + std::to_string(port), HostOf(address),
                  IsLoopback(address));
  label.address = address;
  return label;
}

}  // namespace furrow::server

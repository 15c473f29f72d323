// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/status.h"

namespace furrow::server {

// How clients reach a node of a cluster.
struct NodeAddress {
  std::string name;  // of the node: the audience of tokens for it
  std::string host;  // a name or a numeric address, without brackets
  std::uint16_t tcp = 0;
  std::uint16_t udp = 0;
  std::uint16_t http = 0;  // 0: the node has no web port
  bool https = false;      // a web port speaks HTTPS, not HTTP
  friend bool operator==(const NodeAddress&, const NodeAddress&) = default;
};

// True for names that a node may have: 1 to 47 letters, digits, '-' and '_'.
[[nodiscard]] bool IsNodeName(std::string_view name);

// True for names and numeric addresses of hosts: 1 to 255 letters, digits and '.', ':', '-', '_',
// '%'.
[[nodiscard]] bool IsHost(std::string_view host);

// Where browsers reach the node: "https://10.0.0.2:7480"; empty if they do not.
[[nodiscard]] std::string WebAddressOf(const NodeAddress& node);

// "NAME=HOST" or "NAME=HOST:TCP:UDP:HTTP", with brackets around an IPv6 address. Error:
// kInvalidArgument.
[[nodiscard]] Result<NodeAddress> ParseNode(std::string_view text);

}  // namespace furrow::server

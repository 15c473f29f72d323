// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/status.h"

namespace furrow::server {

// A numeric IPv4 or IPv6 address, without brackets, and a port.
struct HostPort {
  std::string host;
  std::uint16_t port = 0;
  friend bool operator==(const HostPort&, const HostPort&) = default;
};

// Parses "127.0.0.1:9000" or "[::1]:9000". Errors: kInvalidArgument for a host name, for port 0 and
// for an IPv6 address without brackets.
[[nodiscard]] Result<HostPort> ParseHostPort(std::string_view text);

// "127.0.0.1:9000" or "[::1]:9000".
[[nodiscard]] std::string HostPortText(const HostPort& address);

// The host that an address counts to in fair shares: an IPv4 address itself; for an IPv6 address
// its network of 64 bits, because one customer has all of that. Other text is returned unchanged.
[[nodiscard]] std::string HostOf(const std::string& address);

// True for the addresses by which programs of this computer reach it: 127.0.0.0/8 and ::1, also
// mapped into IPv6.
[[nodiscard]] bool IsLoopback(const std::string& address);

// True for "127.0.0.1" and "::1"; false for host names and for addresses in brackets.
[[nodiscard]] bool IsNumericAddress(const std::string& address);

}  // namespace furrow::server

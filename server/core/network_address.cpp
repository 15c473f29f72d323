// SPDX-License-Identifier: Apache-2.0
#include "server/core/network_address.h"

#include <algorithm>
#include <charconv>
#include <iterator>

#include <arpa/inet.h>
#include <netinet/in.h>

namespace furrow::server {

Result<HostPort> ParseHostPort(std::string_view text) {
  const Status error(StatusCode::kInvalidArgument,
                     "'" + std::string(text) + "' is not a numeric HOST:PORT", "",
                     "give an address and a port: 127.0.0.1:9000 or [::1]:9000");
  // The last colon separates the port; an IPv6 address has more of them and therefore needs
  // brackets.
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos) return error;
  std::string_view host = text.substr(0, colon);
  const std::string_view port = text.substr(colon + 1);
  if (host.size() >= 2 && host.front() == '[' && host.back() == ']') {
    host = host.substr(1, host.size() - 2);
  } else if (host.find(':') != std::string_view::npos) {
    return error;
  }
  HostPort result{std::string(host), 0};
  // from_chars() accepts no sign, no space and no value above 65,535 for this type.
  const auto [end, code] = std::from_chars(port.data(), port.data() + port.size(), result.port);
  if (code != std::errc() || end != port.data() + port.size() || result.port == 0 ||
      !IsNumericAddress(result.host)) {
    return error;
  }
  return result;
}

std::string HostPortText(const HostPort& address) {
  const bool v6 = address.host.find(':') != std::string::npos;
  return (v6 ? "[" + address.host + "]:" : address.host + ":") + std::to_string(address.port);
}

std::string HostOf(const std::string& address) {
  in6_addr bytes;
  // "fe80::1%eth0" names an interface of this computer behind the address.
  const std::string plain = address.substr(0, address.find('%'));
  if (inet_pton(AF_INET6, plain.c_str(), &bytes) != 1) return address;
  char text[INET6_ADDRSTRLEN];
  if (IN6_IS_ADDR_V4MAPPED(&bytes)) {
    constexpr std::size_t kIpv4 = 12;  // the offset of the mapped address
    return inet_ntop(AF_INET, &bytes.s6_addr[kIpv4], text, sizeof(text));
  }
  std::fill(std::begin(bytes.s6_addr) + 8, std::end(bytes.s6_addr), std::uint8_t{0});
  return inet_ntop(AF_INET6, &bytes, text, sizeof(text));
}

bool IsLoopback(const std::string& address) {
  in6_addr bytes;
  if (inet_pton(AF_INET6, address.c_str(), &bytes) != 1) {
    in_addr v4;
    return inet_pton(AF_INET, address.c_str(), &v4) == 1 && (ntohl(v4.s_addr) >> 24) == 127;
  }
  constexpr std::size_t kIpv4 = 12;  // the offset of the mapped address
  return IN6_IS_ADDR_LOOPBACK(&bytes) ||
         (IN6_IS_ADDR_V4MAPPED(&bytes) && bytes.s6_addr[kIpv4] == 127);
}

bool IsNumericAddress(const std::string& address) {
  in6_addr buffer;  // large enough for both families
  return inet_pton(AF_INET, address.c_str(), &buffer) == 1 ||
         inet_pton(AF_INET6, address.c_str(), &buffer) == 1;
}

}  // namespace furrow::server

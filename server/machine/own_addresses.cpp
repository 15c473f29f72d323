// SPDX-License-Identifier: Apache-2.0
#include "server/machine/own_addresses.h"

#include <algorithm>
#include <memory>
#include <string_view>

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>

#include "server/core/network_address.h"

namespace furrow::server {
namespace {

bool IsAny(const std::string& address) { return address == "0.0.0.0" || address == "::"; }

// Empty for addresses that other computers cannot use.
std::string TextOf(const sockaddr& address) {
  char text[INET6_ADDRSTRLEN];
  if (address.sa_family == AF_INET) {
    const in_addr& v4 = reinterpret_cast<const sockaddr_in&>(address).sin_addr;
    const bool is_link_local = (ntohl(v4.s_addr) >> 16) == 0xA9FE;  // 169.254.0.0/16
    return is_link_local ? "" : inet_ntop(AF_INET, &v4, text, sizeof(text));
  }
  if (address.sa_family != AF_INET6) return {};
  const in6_addr& v6 = reinterpret_cast<const sockaddr_in6&>(address).sin6_addr;
  return IN6_IS_ADDR_LINKLOCAL(&v6) ? "" : inet_ntop(AF_INET6, &v6, text, sizeof(text));
}

}  // namespace

std::vector<std::string> ReachableAddresses(const std::string& bind) {
  if (IsLoopback(bind)) return {};
  if (!IsAny(bind)) return {bind};
  ifaddrs* first = nullptr;
  if (getifaddrs(&first) != 0) return {};
  const std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> list(first, &freeifaddrs);
  std::vector<std::string> found;
  for (const ifaddrs* each = first; each != nullptr; each = each->ifa_next) {
    const bool is_up = (each->ifa_flags & IFF_UP) != 0;
    if (each->ifa_addr == nullptr || !is_up || (each->ifa_flags & IFF_LOOPBACK) != 0) continue;
    if (each->ifa_addr->sa_family == AF_INET6 && bind != "::") continue;
    std::string text = TextOf(*each->ifa_addr);
    if (!text.empty()) found.push_back(std::move(text));
  }
  // Not of std::ranges, whose subranges clang 14 does not compile; the fuzzers need it.
  std::stable_partition(found.begin(), found.end(), [](const std::string& address) {
    return address.find(':') == std::string::npos;
  });
  return found;
}

bool IsOwnAddress(const std::string& address) {
  if (IsLoopback(address)) return true;
  const std::vector<std::string> own = ReachableAddresses("::");
  // A socket for both families shows IPv4 addresses as "::ffff:10.0.0.1".
  constexpr std::string_view kMapped = "::ffff:";
  const bool is_mapped = address.starts_with(kMapped) && address.find('.') != std::string::npos;
  const std::string plain = is_mapped ? address.substr(kMapped.size()) : address;
  return std::find(own.begin(), own.end(), plain) != own.end();
}

}  // namespace furrow::server

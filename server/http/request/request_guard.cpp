// SPDX-License-Identifier: Apache-2.0
#include "server/http/request/request_guard.h"

#include <algorithm>

#include "base/ascii.h"
#include "server/core/network_address.h"

namespace furrow::server {
namespace {

// Host names and origins ignore case (RFC 9110 section 4.2.3).
bool Contains(const std::vector<std::string>& list, std::string_view text) {
  return std::ranges::any_of(list,
                             [&](const std::string& item) { return EqualsIgnoreCase(item, text); });
}

}  // namespace

std::string_view HostName(std::string_view host) {
  if (host.starts_with('[')) {
    const std::size_t end = host.find(']');
    return end == std::string_view::npos ? host : host.substr(1, end - 1);
  }
  return host.substr(0, host.find(':'));
}

std::string RequestGuard::Check(std::string_view host, std::string_view origin) const {
  // A numeric address cannot be rebound by DNS, and browsers resolve "localhost" to loopback.
  const std::string name(HostName(host));
  if (!IsNumericAddress(name) && !EqualsIgnoreCase(name, "localhost") && !Contains(hosts_, name)) {
    return "Host '" + name + "' is not allowed; add it with --allow-host or http.allow_hosts";
  }
  if (origin.empty() || Contains(origins_, origin)) return {};
  // The page of this daemon: its Origin is the Host with a scheme in front.
  for (const std::string_view scheme : {"http://", "https://"}) {
    if (origin.starts_with(scheme) && EqualsIgnoreCase(origin.substr(scheme.size()), host))
      return {};
  }
  return "Origin '" + std::string(origin) + "' is not allowed; add it to http.allow_origins";
}

}  // namespace furrow::server

// SPDX-License-Identifier: Apache-2.0
#include "server/http/request/request_guard.h"

#include <algorithm>

#include <arpa/inet.h>
#include <netinet/in.h>

namespace furrow::server {
namespace {

bool IsNumeric(const std::string& host) {
  in6_addr buffer;
  return inet_pton(AF_INET, host.c_str(), &buffer) == 1 ||
         inet_pton(AF_INET6, host.c_str(), &buffer) == 1;
}

bool EqualText(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; };
  return std::ranges::equal(a, b, {}, lower, lower);
}

bool Contains(const std::vector<std::string>& list, std::string_view text) {
  return std::ranges::any_of(list, [&](const std::string& item) { return EqualText(item, text); });
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
  const std::string name(HostName(host));
  if (!IsNumeric(name) && !EqualText(name, "localhost") && !Contains(hosts_, name)) {
    return "Host '" + name + "' is not a name of this daemon: see http.allow_hosts";
  }
  if (origin.empty() || Contains(origins_, origin)) return {};
  for (const std::string_view scheme : {"http://", "https://"}) {
    if (origin.starts_with(scheme) && EqualText(origin.substr(scheme.size()), host)) return {};
  }
  return "Origin '" + std::string(origin) + "' may not ask this daemon: see http.allow_origins";
}

}  // namespace furrow::server

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "server/config/http_config.h"

namespace furrow::server {

// Protects a daemon on loopback or a private network from foreign web pages.
//
// A page of evil.example can send requests to the daemon from the operator's browser. The check of
// Origin rejects them. If evil.example resolves to the daemon's address (DNS rebinding), Origin and
// Host agree, and the check of the name in Host rejects them.
class RequestGuard {
 public:
  explicit RequestGuard(const HttpConfig& config)
      : hosts_(config.allow_hosts), origins_(config.allow_origins) {}

  // Returns an empty string, or why the request is forbidden. `origin`: empty if the request has
  // none, as from clients other than browsers.
  [[nodiscard]] std::string Check(std::string_view host, std::string_view origin) const;

 private:
  std::vector<std::string> hosts_;
  std::vector<std::string> origins_;
};

// The name or address without port and brackets: "localhost" for "localhost:7480", "::1" for
// "[::1]:80".
[[nodiscard]] std::string_view HostName(std::string_view host);

}  // namespace furrow::server

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "server/config/http_config.h"

namespace furrow::server {

// Keeps strangers' pages away from a daemon that listens on loopback or a private network.
//
// A page of evil.example can send requests here from the browser of whoever runs the daemon. Its
// Origin tells on it; and where it points its own name at our address (DNS rebinding), so that
// Origin and Host agree, the name in Host does.
class RequestGuard {
 public:
  explicit RequestGuard(const HttpConfig& config)
      : hosts_(config.allow_hosts), origins_(config.allow_origins) {}

  // Empty: may pass. Else why not. `origin` is empty where the request has none (no browser).
  [[nodiscard]] std::string Check(std::string_view host, std::string_view origin) const;

 private:
  std::vector<std::string> hosts_;
  std::vector<std::string> origins_;
};

// "localhost" of "localhost:7480", "::1" of "[::1]:80".
[[nodiscard]] std::string_view HostName(std::string_view host);

}  // namespace furrow::server

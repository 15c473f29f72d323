// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "server/config/http_config.h"

namespace furrow::server {

// Protects a daemon on loopback or a private network from foreign web pages.
//
// A page of evil.example can send requests to the daemon from the operator's browser; the check of
// the header Origin rejects them. If evil.example resolves to the daemon's address (DNS rebinding),
// the headers Origin and Host agree; the check of the name in Host rejects such requests.
class RequestGuard {
 public:
  explicit RequestGuard(const HttpConfig& config)
      : hosts_(config.allow_hosts), origins_(config.allow_origins) {}

  // Returns an empty string if the request is allowed, else why it is forbidden. `host`, `origin`:
  // the headers; `origin` is empty if there is none, as from clients other than browsers.
  [[nodiscard]] std::string Check(std::string_view host, std::string_view origin) const;

 private:
  std::vector<std::string> hosts_;
  std::vector<std::string> origins_;
};

// Returns the name or address in a Host header without port and brackets: "localhost" for
// "localhost:7480", "::1" for
// "[::1]:80".
[[nodiscard]] std::string_view HostName(std::string_view host);

}  // namespace furrow::server

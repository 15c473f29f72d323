// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace furrow::server {

// The daemon's web side (docs/HTTP-API.md).
struct HttpConfig {
  static constexpr std::uint16_t kDefaultPort = 7480;
  bool enabled = true;
  // Absent: kDefaultPort, or any free one where that is taken. 0: any free one.
  std::optional<std::uint16_t> port;
  std::vector<std::string> allow_hosts;    // names that a request's Host may have
  std::vector<std::string> allow_origins;  // "https://stage.example": pages of others that may ask
  int max_connections = 128;
  std::filesystem::path page;  // folder; empty: share/furrow/web
  friend bool operator==(const HttpConfig&, const HttpConfig&) = default;
};

}  // namespace furrow::server

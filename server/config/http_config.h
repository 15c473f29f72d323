// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace furrow::server {

// Configuration of the web server (docs/HTTP-API.md).
struct HttpConfig {
  static constexpr std::uint16_t kDefaultPort = 7480;
  bool enabled = true;
  // Absent: kDefaultPort, or any free port if that is in use. 0: any free port.
  std::optional<std::uint16_t> port;
  std::vector<std::string> allow_hosts;    // names accepted in the Host field
  std::vector<std::string> allow_origins;  // foreign pages that may connect and show /embed in a
                                           // frame: "https://stage.example"
  int max_connections = 256;               // at a time, [1, 1'000'000]; one host gets half
  // Part of the time of the main network thread that API requests of one host may use, (0, 1];
  // 1: no limit.
  double api_share = 0.1;
  // Requests of one host, of whatever kind, that are answered at once, [1, 1'000'000]; further ones
  // wait.
  int requests_per_second = 500;
  // Largest recording that a client may upload, [0, kMostUploadMegabytes]; 0: none.
  int max_upload_megabytes = 64;
  static constexpr int kMostUploadMegabytes = 1000;
  std::filesystem::path page;  // folder of the page; empty: share/furrow/web
  [[nodiscard]] std::uint64_t upload_bytes() const {
    return static_cast<std::uint64_t>(max_upload_megabytes) * 1'000'000;
  }
  friend bool operator==(const HttpConfig&, const HttpConfig&) = default;
};

}  // namespace furrow::server

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace furrow::server {

// What this process uses of its computer. Values that the system does not tell are 0.
struct ProcessStats {
  double cpu_seconds = 0.0;  // user and system
  std::uint64_t resident_bytes = 0;
  std::uint64_t virtual_bytes = 0;
  std::uint64_t threads = 0;
  std::uint64_t open_files = 0;
  std::uint64_t max_files = 0;
};

[[nodiscard]] ProcessStats ReadProcessStats();

}  // namespace furrow::server

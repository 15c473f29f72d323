// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace furrow::load {

// What a process of this machine has used, as /proc tells.
struct ProcessUsage {
  double cpu_seconds = 0.0;  // of all its threads, since it started
  std::uint64_t resident_bytes = 0;
  std::uint64_t peak_resident_bytes = 0;
};

// Nothing where there is no such process, or it is not ours to ask.
[[nodiscard]] std::optional<ProcessUsage> ReadUsage(int pid,
                                                    const std::filesystem::path& proc = "/proc");

// The process of this machine that owns a port: `table` is "udp" or "tcp" (a listener). Nothing
// where none does, or it belongs to another user. Both families are looked through.
[[nodiscard]] std::optional<int> FindPortOwner(const char* table, std::uint16_t port,
                                               const std::filesystem::path& proc = "/proc");

}  // namespace furrow::load

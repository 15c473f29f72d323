// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace furrow::load {

// Resources used by a process on this machine, from /proc.
struct ProcessUsage {
  double cpu_seconds = 0.0;  // of all threads, since the start of the process
  std::uint64_t resident_bytes = 0;
  std::uint64_t peak_resident_bytes = 0;
};

// Reads the usage of process `pid`. Returns nothing if the process does not exist or is not
// readable. `proc`: the mount point of procfs.
[[nodiscard]] std::optional<ProcessUsage> ReadUsage(int pid,
                                                    const std::filesystem::path& proc = "/proc");

// Finds the process on this machine that owns an IPv4 or IPv6 port. `table` is "udp", or "tcp" for
// a listening socket. Returns nothing if there is none or if it belongs to another user.
[[nodiscard]] std::optional<int> FindPortOwner(const char* table, std::uint16_t port,
                                               const std::filesystem::path& proc = "/proc");

}  // namespace furrow::load

// SPDX-License-Identifier: Apache-2.0
#include "server/machine/process_stats.h"

#include <filesystem>
#include <fstream>
#include <iterator>

#include <sys/resource.h>
#include <unistd.h>

namespace furrow::server {
namespace {

double SecondsOf(const timeval& time) {
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) * 1e-6;
}

// The entries of a folder below /proc/self.
std::uint64_t CountEntries(const char* folder) {
  std::error_code error;
  std::uint64_t count = 0;
  for (std::filesystem::directory_iterator it(folder, error), end; !error && it != end;
       it.increment(error)) {
    ++count;
  }
  return count;
}

}  // namespace

ProcessStats ReadProcessStats() {
  ProcessStats stats;
  rusage usage{};
  if (getrusage(RUSAGE_SELF, &usage) == 0) {
    stats.cpu_seconds = SecondsOf(usage.ru_utime) + SecondsOf(usage.ru_stime);
  }
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) == 0) stats.max_files = limit.rlim_cur;
  // The first two numbers are pages: all, and resident (proc(5)).
  std::ifstream memory("/proc/self/statm");
  const auto page = static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
  if (memory >> stats.virtual_bytes >> stats.resident_bytes) {
    stats.virtual_bytes *= page;
    stats.resident_bytes *= page;
  }
  stats.threads = CountEntries("/proc/self/task");
  stats.open_files = CountEntries("/proc/self/fd");
  return stats;
}

}  // namespace furrow::server

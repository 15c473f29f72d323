// SPDX-License-Identifier: Apache-2.0
#include "client/load/measure/process_usage.h"

#include <charconv>
#include <fstream>
#include <set>
#include <sstream>
#include <string>

namespace furrow::load {
namespace {

namespace fs = std::filesystem;

// Adds the inodes of the sockets with that port. A line of the table holds: number, local
// address:port, remote address:port, state, four other fields, timeout, inode. Addresses and ports
// are hexadecimal. State 0A is "listening".
void AddInodes(const fs::path& table, std::uint16_t port, bool listening,
               std::set<std::string>* inodes) {
  std::ifstream file(table);
  std::string line;
  std::getline(file, line);  // skip the header
  while (std::getline(file, line)) {
    std::istringstream fields(line);
    std::string number, local, remote, state, queues, timer, retransmits, user, timeout, inode;
    fields >> number >> local >> remote >> state >> queues >> timer >> retransmits >> user >>
        timeout >> inode;
    const std::size_t colon = local.rfind(':');
    if (!fields || colon == std::string::npos) continue;
    unsigned value = 0;
    std::from_chars(local.data() + colon + 1, local.data() + local.size(), value, 16);
    if (value == port && (!listening || state == "0A")) inodes->insert("socket:[" + inode + "]");
  }
}

// True if a descriptor of the process is one of these sockets. Other users' processes are
// unreadable.
bool OwnsAny(const fs::path& process, const std::set<std::string>& inodes) {
  std::error_code error;
  for (fs::directory_iterator it(process / "fd", error), end; !error && it != end;
       it.increment(error)) {
    // A descriptor may close between listing and reading; which is not an error.
    std::error_code gone;
    if (inodes.contains(fs::read_symlink(it->path(), gone).string())) return true;
  }
  return false;
}

// The times in /proc/PID/stat count whole ticks of 10 ms, too coarse for a run of a second.
// Processor time of one thread: the first number of schedstat, in nanoseconds.
double ThreadSeconds(const fs::path& thread) {
  std::ifstream file(thread / "schedstat");
  std::uint64_t nanoseconds = 0;
  file >> nanoseconds;
  return static_cast<double>(nanoseconds) * 1e-9;
}

}  // namespace

std::optional<ProcessUsage> ReadUsage(int pid, const fs::path& proc) {
  const fs::path process = proc / std::to_string(pid);
  std::ifstream status(process / "status");
  if (!status) return std::nullopt;
  ProcessUsage usage;
  std::string key;
  while (status >> key) {
    std::uint64_t kilobytes = 0;
    if (key == "VmRSS:" && status >> kilobytes) usage.resident_bytes = kilobytes * 1024;
    if (key == "VmHWM:" && status >> kilobytes) usage.peak_resident_bytes = kilobytes * 1024;
  }
  std::error_code error;
  for (fs::directory_iterator it(process / "task", error), end; !error && it != end;
       it.increment(error)) {
    // The file of the process itself covers only its main thread.
    usage.cpu_seconds += ThreadSeconds(it->path());
  }
  return usage;
}

std::optional<int> FindPortOwner(const char* table, std::uint16_t port, const fs::path& proc) {
  const bool listening = std::string(table) == "tcp";
  std::set<std::string> inodes;
  for (const char* family : {"", "6"})
    AddInodes(proc / "net" / (std::string(table) + family), port, listening, &inodes);
  if (inodes.empty()) return std::nullopt;
  std::error_code error;
  for (fs::directory_iterator it(proc, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    int pid = 0;
    const auto parsed = std::from_chars(name.data(), name.data() + name.size(), pid);
    if (parsed.ec != std::errc() || parsed.ptr != name.data() + name.size()) continue;
    if (OwnsAny(it->path(), inodes)) return pid;
  }
  return std::nullopt;
}

}  // namespace furrow::load

// SPDX-License-Identifier: Apache-2.0
#include "bench/load/daemon_process.h"

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <string>
#include <utility>

#include <sched.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace furrow::bench {
namespace {

// The cores of this program when it asked first, before it moved.
const cpu_set_t& AllCores() {
  static const cpu_set_t kAll = [] {
    cpu_set_t all;
    sched_getaffinity(0, sizeof(all), &all);
    return all;
  }();
  return kAll;
}

// The first `count` cores, but never the last core, which is left for this program.
cpu_set_t FirstCores(int count) {
  const cpu_set_t& all = AllCores();
  const int wanted = std::max(1, std::min(count, CPU_COUNT(&all) - 1));
  cpu_set_t chosen;
  CPU_ZERO(&chosen);
  for (int core = 0; core < CPU_SETSIZE && CPU_COUNT(&chosen) < wanted; ++core) {
    if (CPU_ISSET(core, &all)) CPU_SET(core, &chosen);
  }
  return chosen;
}

// All cores but the first `count`. A machine with one core keeps its only core.
void PinToOthers(int count) {
  const cpu_set_t first = FirstCores(count);
  cpu_set_t others;
  CPU_XOR(&others, &AllCores(), &first);
  if (CPU_COUNT(&others) > 0) sched_setaffinity(0, sizeof(others), &others);
}

void WriteConfig(const std::filesystem::path& file, const DaemonSetup& setup) {
  std::ofstream config(file);
  config << "[listen]\nthreads = " << setup.threads << "\n";
  // A daemon of an older version does not know the key.
  if (setup.busy_poll_us > 0) config << "busy_poll_us = " << setup.busy_poll_us << "\n";
  config << "[limits]\nmax_subjects = 20000\n";
  if (!setup.keys.empty()) config << "[security]\nkeys = \"" << setup.keys.string() << "\"\n";
}

// Returns 7401 for "... udp=127.0.0.1:7401 ...", or 0 if there is no port.
std::uint16_t PortOf(const std::string& line, const std::string& name) {
  const std::size_t at = line.find(" " + name + "=");
  const std::size_t colon = at == std::string::npos ? at : line.find(':', at);
  if (colon == std::string::npos) return 0;
  return static_cast<std::uint16_t>(std::strtoul(line.c_str() + colon + 1, nullptr, 10));
}

std::string ReadLine(int descriptor) {
  std::string line;
  for (char c = 0; read(descriptor, &c, 1) == 1 && c != '\n';) line += c;
  return line;
}

}  // namespace

int NumCores() { return CPU_COUNT(&AllCores()); }

Result<DaemonProcess> DaemonProcess::Start(const std::filesystem::path& program,
                                           const std::filesystem::path& rig,
                                           const std::filesystem::path& folder,
                                           const DaemonSetup& setup) {
  const std::filesystem::path config = folder / "load.toml";
  WriteConfig(config, setup);
  std::array<int, 2> pipe_ends{};
  if (pipe(pipe_ends.data()) != 0) return Status(StatusCode::kIo, "no pipe");
  const cpu_set_t cores = setup.is_pinned ? FirstCores(setup.threads) : AllCores();
  if (setup.is_pinned) PinToOthers(setup.threads);
  const int pid = fork();
  if (pid < 0) return Status(StatusCode::kIo, "no process");
  if (pid == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    sched_setaffinity(0, sizeof(cores), &cores);
    dup2(pipe_ends[1], STDOUT_FILENO);
    if (std::freopen((folder / "furrowd.log").c_str(), "a", stderr) == nullptr) _exit(126);
    execl(program.c_str(), program.c_str(), "--no-render", "--no-http", "--tcp", "0", "--udp", "0",
          "--config", config.c_str(), "--rig", rig.c_str(), nullptr);
    _exit(127);
  }
  close(pipe_ends[1]);
  const std::string ready = ReadLine(pipe_ends[0]);
  close(pipe_ends[0]);
  DaemonProcess daemon(
      {.host = "127.0.0.1", .udp = PortOf(ready, "udp"), .tcp = PortOf(ready, "tcp"), .pid = pid});
  if (daemon.target().udp == 0) {
    return Status(StatusCode::kUnavailable, "did not start", program.string(),
                  "see " + (folder / "furrowd.log").string());
  }
  return daemon;
}

DaemonProcess::DaemonProcess(DaemonProcess&& other) noexcept
    : target_(std::exchange(other.target_, {})) {}

DaemonProcess::~DaemonProcess() {
  if (!target_.pid) return;
  kill(*target_.pid, SIGKILL);
  waitpid(*target_.pid, nullptr, 0);
}

}  // namespace furrow::bench

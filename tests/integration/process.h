// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace furrow::testing_net {

// A child process with pipes for stdout and stderr.
class Process {
 public:
  // What a service manager passes to a process it starts (sd_listen_fds(3), sd_notify(3)).
  struct Service {
    std::string notify_socket;  // path; empty: none
    std::vector<int> sockets;   // become the descriptors from 3 on
    std::string names;          // of the sockets, separated by colons
  };
  explicit Process(std::vector<std::string> command, const Service& service = {});
  ~Process();  // kills the process if it is running
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  // The next line of stdout without its line end; nullopt at the end.
  std::optional<std::string> ReadLine();
  [[nodiscard]] pid_t id() const { return pid_; }
  void Signal(int signal) const;
  // Closes the reading end of stderr.
  void CloseErrors();
  // Waits for the process. Returns the exit code, or 128 + the signal number.
  int Wait();
  // All of stderr; call it after Wait().
  std::string ReadErrors();

 private:
  pid_t pid_ = -1;
  int out_ = -1;
  int errors_ = -1;
  std::string buffer_;
};

// The path of a program on PATH; empty if it is not installed.
[[nodiscard]] std::string FindProgram(const std::string& name);

// furrowd with a rig, without pictures, and with a free port for its web server. `more`: arguments
// that follow.
[[nodiscard]] std::vector<std::string> FurrowdCommand(const std::vector<std::string>& more);

}  // namespace furrow::testing_net

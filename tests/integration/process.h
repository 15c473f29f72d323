// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace furrow::testing_net {

// A program run beside the test, its stdout and stderr in pipes.
class Process {
 public:
  explicit Process(std::vector<std::string> command);
  ~Process();  // kills what still runs
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  // The next line of stdout without its end; none at the end of the stream.
  std::optional<std::string> ReadLine();
  void Signal(int signal) const;
  // Nobody reads its stderr any more.
  void CloseErrors();
  // Waits for the end: the exit code, or 128 + the signal that ended it.
  int Wait();
  // All of stderr; call it after Wait().
  std::string ReadErrors();

 private:
  pid_t pid_ = -1;
  int out_ = -1;
  int errors_ = -1;
  std::string buffer_;
};

// Where a program of this name is on the PATH; empty when it is not there.
[[nodiscard]] std::string FindProgram(const std::string& name);

}  // namespace furrow::testing_net

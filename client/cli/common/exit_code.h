// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/status.h"

namespace furrow::cli {

// Exit codes of `furrow`, as --help lists them.
enum ExitCode : int {
  kDone = 0,
  kFailed = 1,        // failure at run time: I/O, no OpenGL, rejected by the daemon
  kUsage = 2,         // invalid command line
  kBadInput = 3,      // invalid input file
  kNoConnection = 4,  // no answer from the daemon
};

// Prints "furrow: <message>" to standard error and returns the exit code of the failure.
[[nodiscard]] int Fail(const Status& status);

}  // namespace furrow::cli

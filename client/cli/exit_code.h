// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/status.h"

namespace furrow::cli {

// What `furrow` and `furrowd` exit with; stands in --help.
enum ExitCode : int {
  kDone = 0,
  kFailed = 1,        // at run time: I/O, no OpenGL, the peer refused
  kUsage = 2,         // wrong command line
  kBadInput = 3,      // a file that is not what it should be
  kNoConnection = 4,  // nobody answers
};

// Prints "furrow: <message>" to standard error and says what to exit with.
[[nodiscard]] int Fail(const Status& status);

}  // namespace furrow::cli

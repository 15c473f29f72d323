// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace furrow::server {

// Exit codes of furrowd. `furrow` uses the same numbers; --help lists them.
enum class ExitCode {
  kOk = 0,        // drained and stopped
  kFailed = 1,    // a run-time failure: a port in use, required OpenGL unavailable
  kUsage = 2,     // an invalid command line
  kBadInput = 3,  // an invalid configuration file, character or rig
};

}  // namespace furrow::server

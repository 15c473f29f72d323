// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace furrow::server {

// How furrowd ends. The numbers are those of `furrow`; --help prints them.
enum class ExitCode {
  kOk = 0,        // served, drained and stopped
  kFailed = 1,    // failed at run time: a port is taken, GL is required and cannot be had
  kUsage = 2,     // the command line is wrong
  kBadInput = 3,  // the config, the character or the rig is wrong
};

}  // namespace furrow::server

// SPDX-License-Identifier: Apache-2.0
#include "client/cli/common/standard_output.h"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "client/cli/common/exit_code.h"

namespace furrow::cli {

Status WriteStandardOutput(std::span<const std::uint8_t> bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), stdout) == bytes.size() &&
      std::fflush(stdout) == 0) {
    return {};
  }
  return {StatusCode::kIo, std::strerror(errno), "standard output"};
}

int StandardOutputFailed() {
  if (errno == EPIPE) return kDone;
  return Fail({StatusCode::kIo, std::strerror(errno), "standard output"});
}

}  // namespace furrow::cli

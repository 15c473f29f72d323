// SPDX-License-Identifier: Apache-2.0
#include "client/cli/common/standard_output.h"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include <poll.h>
#include <unistd.h>

#include "client/cli/common/exit_code.h"

namespace furrow::cli {
namespace {

bool ReaderHasLeft() {
  pollfd output{.fd = STDOUT_FILENO, .events = POLLOUT, .revents = 0};
  return poll(&output, 1, 0) == 1 && (output.revents & (POLLERR | POLLHUP)) != 0;
}

}  // namespace

Status WriteStandardOutput(std::span<const std::uint8_t> bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), stdout) == bytes.size() &&
      std::fflush(stdout) == 0) {
    return {};
  }
  return {StatusCode::kIo, std::strerror(errno), "standard output"};
}

int StandardOutputFailed() {
  if (errno == EPIPE || ReaderHasLeft()) return kDone;
  // An earlier write may have failed, of which nothing but the fact is known.
  return Fail({StatusCode::kIo, errno == 0 ? "the output is incomplete" : std::strerror(errno),
               "standard output"});
}

}  // namespace furrow::cli

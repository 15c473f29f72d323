// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "base/status.h"

namespace furrow::authoring {

// The resources that the child process may use.
struct ChildProcessLimits {
  // Address space in addition to that of this process.
  std::size_t max_memory_bytes = std::size_t{4} << 30;
  unsigned max_cpu_seconds = 120;
  std::size_t max_result_bytes = std::size_t{1} << 30;
};

// Runs `work` in a child process and returns its result. Use it for third-party parsers of
// untrusted files: a crash, excessive memory or an endless loop affects only the child.
//
// - `work` runs on a copy of this process's memory. Only its return value comes back. It must not
//   use other threads or locks that they may hold, because only the calling thread is copied.
// - The call blocks until the child has ended.
// - Memory is not limited under AddressSanitizer and ThreadSanitizer, which reserve terabytes of
//   address space.
// - Errors: those that `work` returned; kLimit (memory, time, size of the result); kParse (the
//   child crashed); kIo (no process or pipe available).
[[nodiscard]] Result<std::string> RunInChildProcess(
    const ChildProcessLimits& limits, const std::function<Result<std::string>()>& work);

}  // namespace furrow::authoring

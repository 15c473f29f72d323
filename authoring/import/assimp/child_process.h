// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "base/status.h"

namespace furrow::authoring {

// What a confined piece of work may use.
struct ChildProcessLimits {
  std::size_t max_memory_bytes = std::size_t{4} << 30;  // address space, besides what we hold now
  unsigned max_cpu_seconds = 120;
  std::size_t max_result_bytes = std::size_t{1} << 30;
};

// Runs `work` in a child process and brings its result back: for parsers that are not ours and read
// files from anywhere. Whatever they do - crash, eat memory, never end - costs the child alone.
//
// - `work` sees a copy of this process's memory as it is now, and only what it returns comes back.
//   It must not rely on other threads: none of them exist in the child.
// - Under AddressSanitizer and ThreadSanitizer, which reserve address space by the terabyte, memory
//   is not limited.
// - Errors: what `work` returned; kLimit (memory, time, result too long); kParse (it crashed);
//   kIo (no process or pipe to be had).
[[nodiscard]] Result<std::string> RunInChildProcess(
    const ChildProcessLimits& confinement, const std::function<Result<std::string>()>& work);

}  // namespace furrow::authoring

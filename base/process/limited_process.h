// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "base/status.h"

namespace furrow {

// The resources of a child process.
struct ProcessLimits {
  std::size_t max_memory_bytes = std::size_t{1} << 30;  // address space
  unsigned max_cpu_seconds = 60;
  unsigned max_seconds = 180;  // wall clock
  std::size_t max_output_bytes = std::size_t{1} << 30;
};

// Runs a program that converts a file, and returns its standard output. Use it for third-party
// parsers of untrusted files: a crash, excessive memory or an endless loop affects only the child.
//
// - The program gets `input` as its standard input, and nothing else: no other descriptors, signal
//   handlers or working folder of this process. Its output goes to a nameless temporary file.
// - The limits apply before the child gets a byte of `input`. Memory is not limited under
//   AddressSanitizer and ThreadSanitizer, which reserve terabytes of address space.
// - The call blocks until the child has ended. Safe in programs with many threads: nothing runs
//   between the creation of the child and its exec.
// - Errors: kLimit (memory, time, size of the output), kParse (the child crashed), kIo (it cannot
//   start, or fails; with the last line of its standard error).
[[nodiscard]] Result<std::string> RunLimited(const std::filesystem::path& program,
                                             std::span<const std::string> arguments,
                                             std::string_view input,
                                             const ProcessLimits& limits = {});

}  // namespace furrow

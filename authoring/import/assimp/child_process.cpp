// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/assimp/child_process.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <exception>
#include <fstream>
#include <new>
#include <string_view>
#include <utility>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace furrow::authoring {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kMemoryCanBeLimited = false;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || \
    __has_feature(memory_sanitizer)
constexpr bool kMemoryCanBeLimited = false;
#else
constexpr bool kMemoryCanBeLimited = true;
#endif
#else
constexpr bool kMemoryCanBeLimited = true;
#endif

// The child sends a StatusCode. The result follows, or the fields of the status with their lengths.
constexpr std::size_t kMaxErrorBytes = 1u << 16;

// Both processes run the same program, so lengths need no fixed byte order.
std::string ErrorMessage(const Status& status) {
  std::string message(1, static_cast<char>(status.code()));
  for (const std::string* text : {&status.what(), &status.where(), &status.todo()}) {
    const auto length = static_cast<std::uint32_t>(std::min(text->size(), kMaxErrorBytes));
    message.append(reinterpret_cast<const char*>(&length), sizeof length);
    message.append(*text, 0, length);
  }
  return message;
}

// The child may have been taken over by a hostile file: every length is checked against what is
// left.
Status ParseError(std::string_view message) {
  const auto code = static_cast<StatusCode>(message.front());
  message.remove_prefix(1);
  std::array<std::string, 3> texts;
  for (std::string& text : texts) {
    std::uint32_t length = 0;
    if (message.size() < sizeof length) break;
    std::memcpy(&length, message.data(), sizeof length);
    message.remove_prefix(sizeof length);
    text = message.substr(0, length);
    message.remove_prefix(text.size());
  }
  return {code, texts[0], texts[1], texts[2]};
}

// The limit on address space counts what the parent had mapped before the fork.
std::size_t AddressSpaceInUse() {
  std::ifstream stat("/proc/self/statm");
  std::size_t pages = 0;
  stat >> pages;
  return pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

void Limit(int resource, rlim_t value) {
  const rlimit limit = {value, value};
  (void)setrlimit(resource, &limit);  // cannot fail except where a lower limit already applies
}

bool WriteAll(int pipe, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = write(pipe, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

// Limits come first, before the child touches the file. _exit() skips destructors and exit
// handlers, which belong to the parent.
[[noreturn]] void RunChild(const ChildProcessLimits& limits, int pipe,
                           const std::function<Result<std::string>()>& work) {
  Limit(RLIMIT_CORE, 0);
  Limit(RLIMIT_FSIZE, 0);  // readers never write files
  Limit(RLIMIT_CPU, limits.max_cpu_seconds);
  if (kMemoryCanBeLimited) Limit(RLIMIT_AS, AddressSpaceInUse() + limits.max_memory_bytes);
  // The parent's handlers must not run here.
  for (const int fatal : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL}) std::signal(fatal, SIG_DFL);
  if (const int null = open("/dev/null", O_WRONLY); null >= 0) dup2(null, STDERR_FILENO);
  std::string message;
  try {
    const Result<std::string> result = work();
    message = result.ok() ? std::string(1, '\0') : ErrorMessage(result.status());
    const bool sent = WriteAll(pipe, message) && (!result.ok() || WriteAll(pipe, *result));
    _exit(sent ? 0 : 1);
  } catch (const std::bad_alloc&) {
    message = ErrorMessage({StatusCode::kLimit, "reading the file takes more than " +
                                                    std::to_string(limits.max_memory_bytes >> 20) +
                                                    " MiB of memory"});
  } catch (const std::exception& exception) {
    message = ErrorMessage({StatusCode::kParse, exception.what()});
  }
  _exit(WriteAll(pipe, message) ? 0 : 1);
}

// Reads the pipe to its end. Returns false if there are more than `max_bytes`.
bool ReadAll(int pipe, std::size_t max_bytes, std::string* bytes) {
  std::array<char, 1 << 16> block;
  for (;;) {
    const ssize_t size = read(pipe, block.data(), block.size());
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) return true;
    if (bytes->size() + static_cast<std::size_t>(size) > max_bytes) return false;
    bytes->append(block.data(), static_cast<std::size_t>(size));
  }
}

// Why a child ended without a result. The kernel sends SIGXCPU at the limit of CPU time.
Status EndOf(int exit_status, const ChildProcessLimits& limits) {
  if (WIFSIGNALED(exit_status)) {
    const int signal = WTERMSIG(exit_status);
    if (signal == SIGXCPU || signal == SIGKILL) {
      return {StatusCode::kLimit, "reading the file takes more than " +
                                      std::to_string(limits.max_cpu_seconds) +
                                      " s of processor time or too much memory"};
    }
    return {StatusCode::kParse, "reading the file crashed (signal " + std::to_string(signal) +
                                    "): the file is damaged"};
  }
  return {StatusCode::kParse, "reading the file failed: it is damaged"};
}

}  // namespace

Result<std::string> RunInChildProcess(const ChildProcessLimits& limits,
                                      const std::function<Result<std::string>()>& work) {
  int ends[2] = {-1, -1};
  if (pipe2(ends, O_CLOEXEC) != 0) return Status(StatusCode::kIo, std::strerror(errno), "pipe");
  const pid_t child = fork();
  if (child < 0) {
    const Status status(StatusCode::kIo, std::strerror(errno), "fork");
    close(ends[0]);
    close(ends[1]);
    return status;
  }
  if (child == 0) {
    close(ends[0]);
    RunChild(limits, ends[1], work);
  }
  close(ends[1]);
  std::string message;
  const bool fits = ReadAll(ends[0], limits.max_result_bytes, &message);
  close(ends[0]);  // ends a child that still writes
  int exit_status = 0;
  while (waitpid(child, &exit_status, 0) < 0 && errno == EINTR) {
  }
  if (!fits)
    return Status(StatusCode::kLimit, "the converted model has more than " +
                                          std::to_string(limits.max_result_bytes >> 20) + " MiB");
  if (exit_status != 0 || message.empty()) return EndOf(exit_status, limits);
  if (message.front() != '\0') return ParseError(message);
  message.erase(0, 1);
  return message;
}

}  // namespace furrow::authoring

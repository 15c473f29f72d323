// SPDX-License-Identifier: Apache-2.0
#include "base/process/helper_call.h"

#include <cerrno>
#include <cstdlib>
#include <exception>
#include <new>

#include <sys/resource.h>
#include <unistd.h>

#include "base/process/find_program.h"

namespace furrow {
namespace {

constexpr std::size_t kBlock = 1u << 20;

std::string ReadInput() {
  std::string input;
  for (;;) {
    const std::size_t size = input.size();
    input.resize(size + kBlock);
    const ssize_t got = read(STDIN_FILENO, input.data() + size, kBlock);
    input.resize(size + (got > 0 ? static_cast<std::size_t>(got) : 0));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return input;
  }
}

bool WriteOutput(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = write(STDOUT_FILENO, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

Status OutOfMemory() {
  rlimit limit = {};
  getrlimit(RLIMIT_AS, &limit);
  return {StatusCode::kLimit, "converting the file takes more than " +
                                  std::to_string(limit.rlim_cur >> 20) + " MiB of memory"};
}

// Encoding counts, too: it copies the payload.
std::string Answer(const std::function<Result<HelperReply>(std::string_view)>& work) {
  try {
    return EncodeReply(work(ReadInput()));
  } catch (const std::bad_alloc&) {
    return EncodeReply(OutOfMemory());
  } catch (const std::exception& exception) {
    return EncodeReply(Status(StatusCode::kParse, exception.what()));
  }
}

}  // namespace

Result<HelperReply> CallHelper(const std::string& name, std::span<const std::string> arguments,
                               std::string_view input, const ProcessLimits& limits) {
  const auto program = FindHelperProgram(name);
  FURROW_RETURN_IF_ERROR(program);
  const Result<std::string> output = RunLimited(*program, arguments, input, limits);
  FURROW_RETURN_IF_ERROR(output);
  return DecodeReply(*output);
}

int AnswerCall(const std::function<Result<HelperReply>(std::string_view)>& work) {
  return WriteOutput(Answer(work)) ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace furrow

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "base/process/helper_reply.h"
#include "base/process/limited_process.h"
#include "base/status.h"

// Both ends of a call to a helper program: a program of ours that reads an untrusted file with a
// third-party parser, in a process with limits.
namespace furrow {

// Finds helper program `name`, runs it with `input` as its standard input, and returns its reply.
// Errors: those of FindHelperProgram(), RunLimited() and the helper itself.
[[nodiscard]] Result<HelperReply> CallHelper(const std::string& name,
                                             std::span<const std::string> arguments,
                                             std::string_view input,
                                             const ProcessLimits& limits = {});

// The main function of a helper program: reads standard input to its end, runs `work` on it and
// writes the reply to standard output. Exceptions of `work` become errors: kLimit (memory), kParse
// (others). Returns the exit code.
[[nodiscard]] int AnswerCall(const std::function<Result<HelperReply>(std::string_view)>& work);

}  // namespace furrow

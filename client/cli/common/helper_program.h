// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "client/cli/common/command.h"

namespace furrow::cli {

// A command of `furrow` that a separate program, its helper program, implements. The load tester
// and the authoring tools are helper programs, so that a build may omit them.
struct HelperCommand {
  const char* name;     // "load", or "rig patch" for a command in a group
  const char* help;     // one line, as `furrow --help` lists it
  const char* program;  // file name of the executable, which is also its CMake target
};

// The help line of one helper command. Precondition: `name` is one.
[[nodiscard]] const char* HelpOf(const std::string& name);

// Adds an entry for helper command `name` to `parent`, which lists it in --help. `parent` is the
// application, or the group of the command.
void AddHelperEntry(CLI::App& parent, const std::string& name);

// The helper command that a command line asks for, or null.
[[nodiscard]] const HelperCommand* FindHelperCommand(int argc, const char* const* argv);

// Replaces this process by the helper program of `command`, with unchanged arguments, which keeps
// the process id and the standard streams. Returns only on failure: prints the reason and returns
// an exit code.
[[nodiscard]] int RunHelperProgram(const HelperCommand& command, const char* const* argv);

}  // namespace furrow::cli

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "client/cli/common/command.h"

namespace furrow::cli {

// Runs `furrow` or one of its helper programs: parses the command line, runs the chosen command and
// returns the exit code. `add_commands` adds the commands of the program. Never throws.
int RunProgram(int argc, const char* const* argv,
               const std::function<void(CLI::App& app, Action& action)>& add_commands);

}  // namespace furrow::cli

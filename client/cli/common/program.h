// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "client/cli/common/command.h"

namespace furrow::cli {

// Parses the command line of `furrow`, runs the chosen command and returns the exit code. Never
// throws. `furrow` and its helper programs differ only in `add_commands`.
int RunProgram(int argc, const char* const* argv,
               const std::function<void(CLI::App& app, Action& action)>& add_commands);

}  // namespace furrow::cli

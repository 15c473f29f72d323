// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

namespace furrow::cli {

// What the command line asked for, once it is parsed: run after CLI11 has checked everything.
using Action = std::function<int()>;

// Each adds one subcommand to `app` and, when it is chosen, sets `action`. A file each.
void AddSolve(CLI::App& app, Action& action);
void AddRender(CLI::App& app, Action& action);
void AddRig(CLI::App& app, Action& action);
void AddConvert(CLI::App& app, Action& action);
void AddCharacter(CLI::App& app, Action& action);
void AddPlay(CLI::App& app, Action& action);
void AddWatch(CLI::App& app, Action& action);
void AddFrames(CLI::App& app, Action& action);

// Parses "WxH" with both in [16, 4096].
[[nodiscard]] bool ParseSize(const std::string& text, int* width, int* height);
// A CLI11 validator for it.
[[nodiscard]] CLI::Validator SizeValidator();

}  // namespace furrow::cli

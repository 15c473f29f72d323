// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/cli/common/command.h"

namespace furrow::cli {

// The commands of the program `furrow`. Each function adds one subcommand to `app`. When the
// command line names the subcommand, parsing sets `action`.
void AddConvert(CLI::App& app, Action& action);
void AddDrain(CLI::App& app, Action& action);
void AddFrames(CLI::App& app, Action& action);
void AddInfo(CLI::App& app, Action& action);
void AddPlay(CLI::App& app, Action& action);
void AddRecord(CLI::App& app, Action& action);
void AddRender(CLI::App& app, Action& action);
void AddRig(CLI::App& app, Action& action);
void AddShapeMapCommand(CLI::App& app, Action& action);
void AddSolve(CLI::App& app, Action& action);
void AddToken(CLI::App& app, Action& action);
void AddWatch(CLI::App& app, Action& action);

}  // namespace furrow::cli

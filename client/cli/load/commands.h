// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/cli/common/command.h"

namespace furrow::cli {

// The commands of the program `furrow-load`. Each function adds one subcommand to `app`. When the
// command line names the subcommand, parsing sets `action`.
void AddLoad(CLI::App& app, Action& action);
void AddChaos(CLI::App& app, Action& action);
void AddPlan(CLI::App& app, Action& action);

}  // namespace furrow::cli

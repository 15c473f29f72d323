// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/cli/common/command.h"

namespace furrow::cli {

// The commands of the program `furrow-author`. Each function adds one subcommand to `app`. When the
// command line names the subcommand, parsing sets `action`.
void AddCharacter(CLI::App& app, Action& action);  // import, check and propose-rig
void AddBake(CLI::App& app, Action& action);
void AddExport(CLI::App& app, Action& action);
void AddRigPatch(CLI::App& app, Action& action);  // `rig patch`; adds the group `rig` to `app`

}  // namespace furrow::cli

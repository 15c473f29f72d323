// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "authoring/import/model/rig_proposal.h"
#include "client/cli/command.h"

namespace furrow::cli {

// The subcommands of `furrow character`, a file each.
void AddCharacterImport(CLI::App& group, Action& action);
void AddCharacterCheck(CLI::App& group, Action& action);
void AddProposeRig(CLI::App& group, Action& action);

// ProposeRig() from the default character to `skeleton`. `map`: the skeleton map to read its names
// by (a file or a name); empty: the one that fits.
[[nodiscard]] Result<authoring::RigProposal> ProposeFromDefault(const wrinkle::Skeleton& skeleton,
                                                                const std::string& map);

// Prints "furrow: note: <text>" for each to standard error.
void PrintNotes(const std::vector<std::string>& notes);

}  // namespace furrow::cli

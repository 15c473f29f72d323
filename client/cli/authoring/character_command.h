// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "authoring/import/model/rig_proposal.h"
#include "client/cli/common/command.h"

namespace furrow::cli {

// The subcommands of `furrow character`. Each has its own source file.
void AddCharacterImport(CLI::App& group, Action& action);
void AddCharacterCheck(CLI::App& group, Action& action);
void AddProposeRig(CLI::App& group, Action& action);

// Proposes a rig for `skeleton` from the default character's rig. `map`: skeleton map of the joint
// names, by file or name; empty: the best match.
[[nodiscard]] Result<authoring::RigProposal> ProposeFromDefault(const wrinkle::Skeleton& skeleton,
                                                                const std::string& map);

// Prints "furrow: note: <text>" to standard error for each note.
void PrintNotes(const std::vector<std::string>& notes);

}  // namespace furrow::cli

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "authoring/import/model/eye_poses.h"
#include "authoring/import/model/rig_proposal.h"
#include "client/cli/common/command.h"
#include "gltf/scene/vrm_look_at.h"

namespace furrow::cli {

// Each function adds one subcommand to `group`, the command `furrow character`. When the command
// line names the subcommand, parsing sets `action`.
void AddCharacterImport(CLI::App& group, Action& action);
void AddCharacterCheck(CLI::App& group, Action& action);
void AddProposeRig(CLI::App& group, Action& action);

// The part of the default character's rig from which a rig is proposed.
enum class ProposalPart {
  kBody,         // for characters with a face of blend shapes
  kBodyAndFace,  // with the drivers of face joints
};

// Proposes a rig for `skeleton` from the default character's rig. `map`: the skeleton map of the
// joint names, by file or by name of a shipped map; empty: the best match. `eyes`: the
// model's; see AddEyePoses(). `roles`: those that the model states (Character::roles). Errors:
// those of loading the default character and the map, and of ProposeRig().
[[nodiscard]] Result<authoring::RigProposal> ProposeFromDefault(
    const wrinkle::Skeleton& skeleton, const std::string& map,
    ProposalPart part = ProposalPart::kBodyAndFace, const authoring::EyeSurface& eyes = {},
    const wrinkle::JointRoles& roles = {});

// Prints "furrow: note: <text>" to standard error for each note.
void PrintNotes(const std::vector<std::string>& notes);

}  // namespace furrow::cli

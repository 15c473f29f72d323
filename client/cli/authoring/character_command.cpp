// SPDX-License-Identifier: Apache-2.0
#include "client/cli/authoring/character_command.h"

#include "client/cli/authoring/commands.h"
#include "client/cli/common/helper_program.h"

namespace furrow::cli {

void AddCharacter(CLI::App& app, Action& action) {
  CLI::App* group = app.add_subcommand("character", HelpOf("character"));
  group->require_subcommand(1);
  AddCharacterImport(*group, action);
  AddCharacterCheck(*group, action);
  AddProposeRig(*group, action);
}

}  // namespace furrow::cli

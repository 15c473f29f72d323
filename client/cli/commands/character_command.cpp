// SPDX-License-Identifier: Apache-2.0
#include "client/cli/commands/character_command.h"

#include "client/cli/command.h"

namespace furrow::cli {

void AddCharacter(CLI::App& app, Action& action) {
  CLI::App* group =
      app.add_subcommand("character", "Character packages: a .glb and its wrinkle rig");
  group->require_subcommand(1);
  AddCharacterImport(*group, action);
  AddCharacterCheck(*group, action);
  AddProposeRig(*group, action);
}

}  // namespace furrow::cli

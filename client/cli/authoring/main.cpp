// SPDX-License-Identifier: Apache-2.0
#include "client/cli/authoring/commands.h"
#include "client/cli/common/program.h"

int main(int argc, char** argv) {
  return furrow::cli::RunProgram(argc, argv, [](CLI::App& app, furrow::cli::Action& action) {
    furrow::cli::AddCharacter(app, action);
    furrow::cli::AddBake(app, action);
    furrow::cli::AddExport(app, action);
    furrow::cli::AddRigPatch(app, action);
  });
}

// SPDX-License-Identifier: Apache-2.0
#include "client/cli/cli.h"

#include "client/cli/commands/commands.h"
#include "client/cli/common/helper_program.h"
#include "client/cli/common/program.h"

namespace furrow::cli {
namespace {

// In the order of `furrow --help`.
void AddCommands(CLI::App& app, Action& action) {
  AddPlay(app, action);
  AddWatch(app, action);
  AddFrames(app, action);
  AddRecord(app, action);
  AddHelperEntry(app, "load");
  AddHelperEntry(app, "chaos");
  AddHelperEntry(app, "plan");
  AddSolve(app, action);
  AddRender(app, action);
  AddRig(app, action);
  AddShapeMapCommand(app, action);
  AddConvert(app, action);
  AddInfo(app, action);
  AddToken(app, action);
  AddDrain(app, action);
  AddHelperEntry(app, "character");
  AddHelperEntry(app, "bake");
  AddHelperEntry(app, "export");
}

}  // namespace

int Run(int argc, const char* const* argv) {
  if (const HelperCommand* command = FindHelperCommand(argc, argv))
    return RunHelperProgram(*command, argv);
  return RunProgram(argc, argv, AddCommands);
}

}  // namespace furrow::cli

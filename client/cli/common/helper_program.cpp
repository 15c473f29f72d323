// SPDX-License-Identifier: Apache-2.0
#include "client/cli/common/helper_program.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <string_view>

#include <unistd.h>

#include "base/process/find_program.h"
#include "client/cli/common/exit_code.h"

namespace furrow::cli {
namespace {

constexpr const char* kLoadProgram = "furrow-load";
constexpr const char* kAuthorProgram = "furrow-author";

constexpr std::array kHelperCommands = {
    HelperCommand{"load", "Load-test a daemon: send many subjects, measure and check the weights",
                  kLoadProgram},
    HelperCommand{"chaos", "Run a proxy that injects network faults, repeatable by a seed",
                  kLoadProgram},
    HelperCommand{"plan", "Estimate the cores, bandwidth and machines for a number of performers",
                  kLoadProgram},
    HelperCommand{"character", "Import and check character packages (.glb with a wrinkle rig)",
                  kAuthorProgram},
    HelperCommand{"bake", "Bake wrinkle maps from the strain of a character's own poses",
                  kAuthorProgram},
    HelperCommand{"export", "Export a character's wrinkle maps, masks and shader for an engine",
                  kAuthorProgram},
    HelperCommand{"rig patch", "Cut a surface patch from a character: a strain driver for a rig",
                  kAuthorProgram}};

// The entry of a command that is in the list.
const HelperCommand& Get(std::string_view name) {
  return *std::ranges::find(kHelperCommands, name, &HelperCommand::name);
}

}  // namespace

const char* HelpOf(const std::string& name) { return Get(name).help; }

void AddHelperEntry(CLI::App& parent, const std::string& name) {
  const std::size_t space = name.rfind(' ');
  parent.add_subcommand(space == std::string::npos ? name : name.substr(space + 1), HelpOf(name));
}

const HelperCommand* FindHelperCommand(int argc, const char* const* argv) {
  std::string words;
  // A command has at most two words, and options come after them.
  for (int i = 1; i < std::min(argc, 3); ++i) {
    words += (i > 1 ? " " : "") + std::string(argv[i]);
    const auto found = std::ranges::find(kHelperCommands, words, &HelperCommand::name);
    if (found != kHelperCommands.end()) return &*found;
  }
  return nullptr;
}

int RunHelperProgram(const HelperCommand& command, const char* const* argv) {
  const auto program = FindHelperProgram(command.program);
  if (!program.ok()) {
    (void)Fail(program.status());
    return kFailed;
  }
  // exec instead of a child process: no signal, stream or exit code needs to be passed on.
  execv(program->c_str(), const_cast<char* const*>(argv));
  return Fail({StatusCode::kIo, std::string("cannot start the program: ") + std::strerror(errno),
               program->string()});
}

}  // namespace furrow::cli

// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "authoring/export/export_package.h"
#include "base/text.h"
#include "client/cli/authoring/commands.h"
#include "client/cli/authoring/staged_folder.h"
#include "client/cli/common/exit_code.h"
#include "client/cli/common/helper_program.h"
#include "client/cli/common/inputs.h"
#include "rig/exports/export_profile.h"

namespace furrow::cli {
namespace {

using authoring::Engine;

struct ExportArguments {
  std::string character;
  std::string rig;
  std::string skeleton_map;
  std::string out;
  Engine engine = Engine::kGeneric;
  int bits = 0;  // 0: the engine's default
  bool derivatives = false;
  motion::LoadOptions read;
};

// A validator of CLI11: an empty text means that the value is valid.
std::string CheckBits(std::string& text) {
  return text == "8" || text == "16" ? std::string() : "'" + text + "' is not one of 8|16";
}

// An export replaces an earlier one, but not the README.md of a project.
Status CheckFolder(const std::filesystem::path& folder) {
  std::error_code ignored;  // StagedFolder reports folders that cannot be read
  if (!std::filesystem::exists(folder / "README.md", ignored)) return {};
  if (std::filesystem::exists(folder / "wrinkles.json", ignored)) return {};
  return {StatusCode::kInvalidArgument,
          "the folder has a README.md and no wrinkles.json, so it is not an earlier export",
          folder.string(), "name a folder of its own with --out"};
}

int Export(const ExportArguments& arguments) {
  if (Status status = CheckFolder(arguments.out); !status.ok()) return Fail(status);
  const auto character = LoadCharacterArgument(arguments.character, arguments.rig, arguments.read,
                                               arguments.skeleton_map);
  if (!character.ok()) return Fail(character.status());
  // Names of other systems are an extra: an installation without the profiles still exports.
  const auto profiles = rig::ShippedExportProfiles();
  if (!profiles.ok()) PrintWarnings({profiles.status().ToString()});
  auto folder = StagedFolder::Create(arguments.out);
  if (!folder.ok()) return Fail(folder.status());
  authoring::ExportOptions options;
  options.engine = arguments.engine;
  if (arguments.bits != 0) options.bits = arguments.bits;
  options.derivatives = arguments.derivatives;
  options.generator = std::string("furrow ") + FURROW_VERSION;
  if (profiles.ok()) options.profiles = *profiles;
  const auto done = authoring::ExportCharacter(
      *character, options,
      [&](const std::string& name, std::string_view bytes) { return folder->Write(name, bytes); });
  if (!done.ok()) return Fail(done.status().At(arguments.character));
  if (Status status = folder->Commit(); !status.ok()) return Fail(status);
  PrintWarnings(done->notes);
  std::fprintf(stderr, "furrow: %s: %s for %s; README.md says what to do\n", arguments.out.c_str(),
               Counted(done->names.size(), "file").c_str(),
               std::string(authoring::TraitsOf(arguments.engine).title).c_str());
  return kDone;
}

}  // namespace

void AddExport(CLI::App& app, Action& action) {
  auto arguments = std::make_shared<ExportArguments>();
  CLI::App* command = app.add_subcommand("export", HelpOf("export"));
  command->add_option("CHARACTER", arguments->character,
                      std::string(kCharacterHelp) + " (default: default)");
  std::map<std::string, Engine> engines;
  for (const authoring::EngineTraits& traits : authoring::Engines()) {
    engines[std::string(traits.name)] = traits.engine;
  }
  AddChoice<Engine>(*command, "--for", arguments->engine, engines,
                    "Engine that the export is for; generic writes portable GLSL");
  command
      ->add_option("--out", arguments->out,
                   "Folder for textures, shaders, wrinkles.json and README.md")
      ->required();
  command->add_option("--rig", arguments->rig,
                      "Wrinkle rig, by file or shipped name (default: the rig of the package)");
  command
      ->add_option("--bits", arguments->bits,
                   "Bits per channel of normal maps, 8 or 16 (default: 16 for generic and "
                   "blender, otherwise 8)")
      ->check(CLI::Validator(CheckBits, ""))
      ->type_name("8|16");
  command->add_flag("--derivatives", arguments->derivatives,
                    "Also write derivative maps: slopes dh/dx and dh/dy, which blend by adding "
                    "(16 bits per channel unless --bits says otherwise)");
  AddSkeletonMap(*command, arguments->skeleton_map);
  AddBvhOptions(*command, arguments->read);
  command->callback([arguments, &action] { action = [arguments] { return Export(*arguments); }; });
}

}  // namespace furrow::cli

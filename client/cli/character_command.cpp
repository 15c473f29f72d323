// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <memory>

#include "character/import/makehuman.h"
#include "client/cli/command.h"
#include "client/cli/exit_code.h"
#include "client/cli/inputs.h"
#include "motion/pose_source.h"

namespace furrow::cli {
namespace {

struct ImportArguments {
  std::string folder;
  std::string out;
  std::string rig;
  character::ImportOptions options;
};

int Import(const ImportArguments& arguments) {
  character::ImportOptions options = arguments.options;
  options.rig = arguments.rig;
  options.poses = motion::CachedPoseSource();
  character::ImportReport report;
  const auto character = character::ImportMakeHuman(arguments.folder, options, &report);
  if (!character.ok()) return Fail(character.status());
  if (Status status = character::WritePackage(*character, arguments.out); !status.ok())
    return Fail(status);
  PrintWarnings(report.warnings);
  std::fprintf(
      stderr,
      "furrow: %s: %d joints, %d vertices, %d triangles; %d body faces hidden under clothes, "
      "%d vertices without weights, %d with more than four\n",
      arguments.out.c_str(), report.joints, report.vertices, report.triangles, report.hidden_faces,
      report.unweighted_vertices, report.truncated_vertices);
  return kDone;
}

}  // namespace

void AddCharacter(CLI::App& app, Action& action) {
  CLI::App* group =
      app.add_subcommand("character", "Character packages: a .glb and its wrinkle rig");
  group->require_subcommand(1);
  auto arguments = std::make_shared<ImportArguments>();
  CLI::App* command = group->add_subcommand(
      "import", "Makes a package of face and clothed body out of MakeHuman's data folder");
  command
      ->add_option("FOLDER", arguments->folder,
                   "The folder that holds 3dobjs/, rigs/, poseunits/ and clothes/")
      ->required();
  command->add_option("--out", arguments->out, "FILE.glb; FILE.rig.json is written beside it")
      ->required();
  command->add_option("--clothes", arguments->options.clothes,
                      "A folder of clothes/; default: the first by name");
  command->add_option("--rig", arguments->rig,
                      "Wrinkle rig to embed; default: the makehuman.json that ships");
  command->add_option("--texture-size", arguments->options.texture_size, "Texels, square")
      ->check(CLI::Range(64, 4096))
      ->capture_default_str();
  command->callback([arguments, &action] { action = [arguments] { return Import(*arguments); }; });
}

}  // namespace furrow::cli

// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <system_error>

#include "authoring/import/model/character_check.h"
#include "authoring/import/model/character_report.h"
#include "authoring/import/model/import_model.h"
#include "base/status.h"
#include "character/package/package.h"
#include "client/cli/authoring/character_command.h"
#include "client/cli/common/exit_code.h"
#include "client/cli/common/inputs.h"
#include "client/cli/common/standard_output.h"
#include "motion/clip/clip.h"

namespace furrow::cli {
namespace {

namespace fs = std::filesystem;

struct CheckArguments {
  std::string file;
  std::string rig;
  std::string map;
  motion::LoadOptions poses;  // of the rig
  bool json = false;
  bool strict = false;
};

// Attaches the requested rig, or the rig beside the file. Returns false if there is none.
Result<bool> AttachOptionalRig(const CheckArguments& arguments, character::Character* character) {
  fs::path path = ResolveRigPath(arguments.rig);
  if (arguments.rig.empty()) {
    path = character::RigBeside(arguments.file);
    std::error_code error;
    if (!fs::exists(path, error)) return false;
  }
  auto rig = LoadRigArgument(path.string(), arguments.poses, arguments.map);
  FURROW_RETURN_IF_ERROR(rig);
  if (Status s = character::AttachRig(std::move(*rig), path.parent_path(), character); !s.ok()) {
    return s.At(path.string());
  }
  return true;
}

int Check(CheckArguments arguments) {
  arguments.file = character::FindCharacterFile(arguments.file).string();
  const auto maps = rig::SkeletonMaps::Load(arguments.map);
  if (!maps.ok()) return Fail(maps.status());
  auto opened = authoring::OpenModel(arguments.file, *maps);
  if (!opened.ok()) return Fail(opened.status());
  const auto rig_given = AttachOptionalRig(arguments, &opened->character);
  if (!rig_given.ok()) return Fail(rig_given.status());
  PrintNotes(opened->remarks);
  PrintWarnings(opened->character.warnings);
  const auto shapes = LoadShapeMatcher({});
  if (!shapes.ok()) return Fail(shapes.status());
  const authoring::CharacterReport report =
      authoring::CheckCharacter(opened->character, opened->notes, *maps, *rig_given, *shapes);
  const std::string text = arguments.json ? ToJson(report) : ToText(report);
  if (Status s = WriteStandardOutput(
          std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
      !s.ok()) {
    return Fail(s);
  }
  const bool usable = report.Count(authoring::Severity::kError) == 0 &&
                      (!arguments.strict || report.Count(authoring::Severity::kWarning) == 0);
  return usable ? kDone : kBadInput;
}

}  // namespace

void AddCharacterCheck(CLI::App& group, Action& action) {
  auto arguments = std::make_shared<CheckArguments>();
  CLI::App* command = group.add_subcommand(
      "check", "Check a model for use with wrinkles; exit with 0 if it is usable, 3 if not");
  command
      ->add_option(
          "FILE", arguments->file,
          "Skinned model: glTF, VRM, FBX, Collada, ..., or the name of a shipped character")
      ->required();
  command->add_option("--rig", arguments->rig,
                      "Wrinkle rig of the model, by file or shipped name (default: <FILE>.rig.json "
                      "beside it, if it "
                      "exists)");
  command->add_option("--map", arguments->map,
                      "Skeleton map of the joint names, by name or file (default: the best match)");
  command->add_flag("--json", arguments->json, "Print one JSON object instead of text");
  command->add_flag("--strict", arguments->strict, "Treat warnings as errors");
  AddBvhOptions(*command, arguments->poses);
  command->callback([arguments, &action] { action = [arguments] { return Check(*arguments); }; });
}

}  // namespace furrow::cli

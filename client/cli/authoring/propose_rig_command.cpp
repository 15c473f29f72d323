// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <filesystem>
#include <memory>
#include <utility>

#include "authoring/import/model/import_model.h"
#include "base/status.h"
#include "base/text.h"
#include "client/cli/authoring/character_command.h"
#include "client/cli/common/exit_code.h"
#include "client/cli/common/inputs.h"
#include "rig/rig_file.h"

namespace furrow::cli {
namespace {

struct ProposeArguments {
  std::string file;
  std::string out;
  std::string map;
};

// Loads the skeleton of a recording, recognised by its extension, or of a model.
Result<wrinkle::Skeleton> SkeletonOf(const std::string& file) {
  const std::filesystem::path extension = std::filesystem::path(file).extension();
  if (extension == ".bvh" || extension == ".mcap" || extension == ".vrma") {
    auto clip = LoadClipArgument(file);
    FURROW_RETURN_IF_ERROR(clip);
    return std::move(clip->skeleton);
  }
  auto model = authoring::OpenModel(file);
  FURROW_RETURN_IF_ERROR(model);
  return std::move(model->character.skeleton);
}

int Propose(const ProposeArguments& arguments) {
  const auto skeleton = SkeletonOf(arguments.file);
  if (!skeleton.ok()) return Fail(skeleton.status());
  const auto proposal = ProposeFromDefault(*skeleton, arguments.map);
  if (!proposal.ok()) return Fail(proposal.status().At(arguments.file));
  if (Status s = rig::SaveRig(proposal->rig, arguments.out); !s.ok()) return Fail(s);
  PrintNotes(proposal->remarks);
  std::fprintf(stderr, "furrow: %s: %s, %s, %s; edit it, then run 'furrow rig check'\n",
               arguments.out.c_str(), Counted(proposal->rig.drivers.size(), "driver").c_str(),
               Counted(proposal->rig.regions.size(), "region").c_str(),
               Counted(proposal->rig.reference_poses.size(), "reference pose").c_str());
  return kDone;
}

}  // namespace

Result<authoring::RigProposal> ProposeFromDefault(const wrinkle::Skeleton& skeleton,
                                                  const std::string& map) {
  const auto maps = rig::SkeletonMaps::Load(map);
  FURROW_RETURN_IF_ERROR(maps);
  const auto shipped = rig::SkeletonMaps::LoadShipped();
  FURROW_RETURN_IF_ERROR(shipped);
  const auto model = LoadCharacterArgument({}, {});
  FURROW_RETURN_IF_ERROR(model);
  const authoring::FoundJoints model_joints = authoring::FindJoints(model->skeleton, *shipped);
  const authoring::FoundJoints joints = authoring::FindJoints(skeleton, *maps);
  return authoring::ProposeRig(model->rig, {&model->skeleton, &model_joints}, {&skeleton, &joints});
}

void PrintNotes(const std::vector<std::string>& notes) {
  for (const std::string& note : notes) std::fprintf(stderr, "furrow: note: %s\n", note.c_str());
}

void AddProposeRig(CLI::App& group, Action& action) {
  auto arguments = std::make_shared<ProposeArguments>();
  CLI::App* command = group.add_subcommand(
      "propose-rig", "Propose a wrinkle rig for a model or a recording, as a start for editing");
  command
      ->add_option("FILE", arguments->file, "Model (glTF, FBX, ...) or recording (BVH, MCAP, VRMA)")
      ->required();
  command->add_option("--out", arguments->out, "Rig to write, RIG.json")->required();
  command->add_option("--map", arguments->map,
                      "Skeleton map of the joint names, by name or file (default: the best match)");
  command->callback([arguments, &action] { action = [arguments] { return Propose(*arguments); }; });
}

}  // namespace furrow::cli

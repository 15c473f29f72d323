// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <filesystem>
#include <memory>
#include <utility>

#include "authoring/import/model/eye_poses.h"
#include "authoring/import/model/import_model.h"
#include "authoring/import/model/shape_face.h"
#include "authoring/shapes/arkit_face.h"
#include "base/files.h"
#include "base/status.h"
#include "base/text.h"
#include "character/package/package.h"
#include "character/pictures/picture_file.h"
#include "client/cli/authoring/character_command.h"
#include "client/cli/common/command.h"
#include "client/cli/common/exit_code.h"
#include "client/cli/common/inputs.h"
#include "rig/near_names.h"
#include "rig/rig_file.h"

namespace furrow::cli {
namespace {

struct ProposeArguments {
  std::string file;
  std::string out;
  std::string map;
  motion::LoadOptions read;  // of a recording
};

// What a rig is proposed for. A recording has no model.
struct RigSubject {
  wrinkle::Skeleton skeleton;
  character::Character model;
  std::optional<gltf::VrmLookAt> look_at;
};

// Loads the skeleton of a recording, recognised by its extension, or a model.
Result<RigSubject> LoadRigSubject(const ProposeArguments& arguments) {
  const std::string& file = arguments.file;
  const std::filesystem::path extension = std::filesystem::path(file).extension();
  if (extension == ".bvh" || extension == ".mcap" || extension == ".vrma" ||
      extension == ".mhpose") {
    auto clip = LoadClipArgument(file, arguments.read);
    FURROW_RETURN_IF_ERROR(clip);
    return RigSubject{.skeleton = std::move(clip->skeleton), .model = {}, .look_at = {}};
  }
  const auto maps = rig::SkeletonMaps::Load(arguments.map);
  FURROW_RETURN_IF_ERROR(maps);
  auto model = authoring::OpenModel(character::FindCharacterFile(file), *maps);
  FURROW_RETURN_IF_ERROR(model);
  wrinkle::Skeleton skeleton = model->character.skeleton;
  return RigSubject{.skeleton = std::move(skeleton),
                    .model = std::move(model->character),
                    .look_at = model->notes.look_at};
}

// Adds the face of a model with ARKit's blend shapes to a proposal, and writes its masks beside the
// rig.
Status ProposeFaceOfShapes(const ProposeArguments& arguments, const authoring::ArkitFace& face,
                           character::Character character, authoring::RigProposal* proposal) {
  constexpr int kMaskSize = 1024;
  const auto arkit = LoadRigArgument("arkit");
  FURROW_RETURN_IF_ERROR(arkit);
  character.rig = std::move(proposal->rig);
  // A rig beside the model names files; the model's own pictures keep their names.
  for (character::Picture& picture : character.pictures) picture.name.clear();
  const auto remarks = authoring::ProposeShapeFace(*arkit, face, kMaskSize, &character);
  FURROW_RETURN_IF_ERROR(remarks);
  proposal->remarks.insert(proposal->remarks.end(), remarks->begin(), remarks->end());
  const std::filesystem::path folder = std::filesystem::path(arguments.out).parent_path();
  for (const auto& [name, index] : character.rig_pictures) {
    const auto png = character::EncodePng(character.pictures[static_cast<std::size_t>(index)]);
    FURROW_RETURN_IF_ERROR(png);
    FURROW_RETURN_IF_ERROR(WriteFileAtomically(folder / (name + ".png"), *png));
    for (wrinkle::Region& region : character.rig.regions) {
      if (region.mask.texture == name) region.mask.texture = name + ".png";
    }
  }
  proposal->rig = std::move(character.rig);
  return {};
}

// The rig for a skeleton, and for the face of the model that it belongs to, if there is one.
Result<authoring::RigProposal> ProposeFor(const ProposeArguments& arguments, RigSubject subject) {
  const auto matcher = LoadShapeMatcher({});
  FURROW_RETURN_IF_ERROR(matcher);
  const authoring::ArkitFace face(subject.model, *matcher);
  const bool shapes = authoring::HasShapeFace(face);
  auto proposal = ProposeFromDefault(subject.skeleton, arguments.map,
                                     shapes ? ProposalPart::kBody : ProposalPart::kBodyAndFace,
                                     {subject.model.meshes, subject.look_at}, subject.model.roles);
  if (shapes && proposal.status().code() == StatusCode::kNotFound) {
    proposal = authoring::RigProposal();
  }
  FURROW_RETURN_IF_ERROR(proposal);
  if (shapes) {
    FURROW_RETURN_IF_ERROR(
        ProposeFaceOfShapes(arguments, face, std::move(subject.model), &*proposal));
  }
  return proposal;
}

// The way out where no map fits the joints, if their names nearly match one.
Result<std::string> OfferMap(const std::string& file, const wrinkle::Skeleton& skeleton) {
  const auto maps = rig::SkeletonMaps::LoadShipped();
  FURROW_RETURN_IF_ERROR(maps);
  const rig::SkeletonRoles near = rig::RolesOfNearNames(maps->maps(), skeleton.joint_names());
  if (near.map.empty()) return std::string();
  return "the joint names nearly match '" + near.map + "' (" + Counted(near.num_roles, "role") +
         "); 'furrow rig propose-map " + file +
         " --out MAP.json' writes a map of them, for --map MAP.json";
}

int Propose(const ProposeArguments& arguments) {
  auto subject = LoadRigSubject(arguments);
  if (!subject.ok()) return Fail(subject.status());
  const wrinkle::Skeleton skeleton = subject->skeleton;
  auto proposal = ProposeFor(arguments, std::move(*subject));
  if (!proposal.ok() || proposal->joints_are_guessed) {
    const auto offer = OfferMap(arguments.file, skeleton);
    if (!offer.ok()) return Fail(offer.status());
    if (!proposal.ok()) {
      const Status& why = proposal.status();
      return Fail(
          Status(why.code(), why.what(), arguments.file, offer->empty() ? why.todo() : *offer));
    }
    if (!offer->empty()) proposal->remarks.push_back(*offer);
  }
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
                                                  const std::string& map, ProposalPart part,
                                                  const authoring::EyeSurface& eyes,
                                                  const wrinkle::JointRoles& roles) {
  const auto maps = rig::SkeletonMaps::Load(map);
  FURROW_RETURN_IF_ERROR(maps);
  const auto shipped = rig::SkeletonMaps::LoadShipped();
  FURROW_RETURN_IF_ERROR(shipped);
  auto model = LoadCharacterArgument({}, {});
  FURROW_RETURN_IF_ERROR(model);
  if (part == ProposalPart::kBody) {
    std::erase_if(model->rig.drivers, [](const wrinkle::Driver& driver) {
      return driver.kind == wrinkle::Driver::Kind::kPose;
    });
  }
  const authoring::FoundJoints model_joints = authoring::FindJoints(model->skeleton, *shipped);
  const authoring::FoundJoints joints = authoring::FindJoints(skeleton, *maps, roles);
  auto proposal =
      authoring::ProposeRig(model->rig, {&model->skeleton, &model_joints}, {&skeleton, &joints});
  if (!proposal.ok()) return proposal;
  authoring::AddEyePoses(skeleton, joints.roles, eyes, &proposal->rig);
  return proposal;
}

void PrintNotes(const std::vector<std::string>& notes) {
  for (const std::string& note : notes) std::fprintf(stderr, "furrow: note: %s\n", note.c_str());
}

void AddProposeRig(CLI::App& group, Action& action) {
  auto arguments = std::make_shared<ProposeArguments>();
  CLI::App* command = group.add_subcommand(
      "propose-rig", "Propose a wrinkle rig for a model or a recording, as a start for editing");
  command
      ->add_option("FILE", arguments->file,
                   "Model (glTF, FBX, ...), name of a shipped character, or recording (BVH, MCAP, "
                   "VRMA)")
      ->required();
  command->add_option("--out", arguments->out, "Rig to write, RIG.json")->required();
  AddReadOptions(*command, arguments->read);
  command->add_option("--map", arguments->map,
                      "Skeleton map of the joint names, by name or file (default: the best match)");
  command->callback([arguments, &action] { action = [arguments] { return Propose(*arguments); }; });
}

}  // namespace furrow::cli

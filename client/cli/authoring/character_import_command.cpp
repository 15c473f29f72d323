// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <system_error>
#include <vector>

#include "authoring/bake/strokes_file.h"
#include "authoring/import/character_package.h"
#include "authoring/import/makehuman/makehuman.h"
#include "authoring/import/makehuman/save/data_folders.h"
#include "authoring/import/model/atlases.h"
#include "authoring/import/model/face_frame.h"
#include "authoring/import/model/import_model.h"
#include "authoring/import/model/shape_face.h"
#include "authoring/shapes/arkit_face.h"
#include "base/ascii.h"
#include "base/files.h"
#include "base/status.h"
#include "base/text.h"
#include "character/package/package.h"
#include "client/cli/authoring/character_command.h"
#include "client/cli/common/exit_code.h"
#include "client/cli/common/inputs.h"
#include "client/cli/common/interrupt.h"
#include "client/cli/common/progress.h"
#include "motion/clip/clip.h"

namespace furrow::cli {
namespace {

struct ImportArguments {
  std::string in;
  std::string out;
  std::string rig;
  std::string map;
  std::vector<std::string> data_folders;
  authoring::ImportOptions makehuman;
  authoring::ModelOptions model;
  motion::LoadOptions poses;  // of the rig
  float depth = 1.0f;         // of the folds of a face of blend shapes
};

int ImportFolder(const std::filesystem::path& folder, const ImportArguments& arguments,
                 authoring::ImportOptions options) {
  options.rig = arguments.rig.empty() ? std::filesystem::path() : ResolveRigPath(arguments.rig);
  const auto poses = RigPoses(arguments.poses, arguments.map);
  if (!poses.ok()) return Fail(poses.status());
  options.poses = *poses;
  Progress progress("importing", 100);
  options.progress = [&](float done) {
    progress.Set(std::lround(100.0f * done));
    return true;
  };
  authoring::ImportReport report;
  const auto character = authoring::ImportMakeHuman(folder, options, &report);
  if (!character.ok()) return Fail(character.status());
  if (Status status = authoring::WriteCharacterPackage(*character, arguments.out); !status.ok())
    return Fail(status);
  PrintNotes(report.notes);
  PrintWarnings(report.warnings);
  std::fprintf(
      stderr,
      "furrow: %s: %s, %s, %s; %s hidden under clothes, %s without weights, %d with more than "
      "four weights\n",
      arguments.out.c_str(), Counted(report.joints, "joint").c_str(),
      Counted(report.vertices, "vertex", "vertices").c_str(),
      Counted(report.triangles, "triangle").c_str(),
      Counted(report.hidden_faces, "body face").c_str(),
      Counted(report.unweighted_vertices, "vertex", "vertices").c_str(), report.truncated_vertices);
  return kDone;
}

int ImportSave(const ImportArguments& arguments) {
  const std::vector<std::filesystem::path> given(arguments.data_folders.begin(),
                                                 arguments.data_folders.end());
  const auto folders = authoring::FindDataFolders(arguments.in, given);
  if (!folders.ok()) return Fail(folders.status());
  authoring::ImportOptions options = arguments.makehuman;
  options.save = arguments.in;
  options.asset_folders = folders->assets;
  return ImportFolder(folders->base, arguments, options);
}

// The folds that are drawn on the default character's face.
Result<std::vector<authoring::BakeStroke>> LoadDefaultStrokes() {
  const auto rig = LoadRigArgument("default");
  FURROW_RETURN_IF_ERROR(rig);
  return authoring::LoadStrokes(ResolveRigPath("default").parent_path() / "default.strokes.json",
                                *rig);
}

// Gives a face of blend shapes its masks, its part of the rig and its wrinkle maps.
Status AddFaceOfShapes(const ImportArguments& arguments, const authoring::ArkitFace& face,
                       character::Character* character) {
  const auto arkit = LoadRigArgument("arkit");
  FURROW_RETURN_IF_ERROR(arkit);
  const int size = arguments.makehuman.texture_size;
  const auto proposed = authoring::ProposeShapeFace(*arkit, face, size, character);
  if (proposed.status().code() == StatusCode::kNotFound) {
    PrintWarnings({"the face gets no wrinkles: " + proposed.status().ToString()});
    return {};
  }
  FURROW_RETURN_IF_ERROR(proposed);
  if (!face.description().empty()) PrintNotes({face.description()});
  PrintNotes(*proposed);
  const auto strokes = LoadDefaultStrokes();
  FURROW_RETURN_IF_ERROR(strokes);
  constexpr int kSteps = 1000;
  Progress bar("baking", kSteps);
  const auto baked = authoring::BakeShapeFace(
      face, *strokes, size, arguments.depth,
      [&](float done) {
        bar.Set(static_cast<std::int64_t>(done * kSteps));
        return !Interrupted();
      },
      character);
  FURROW_RETURN_IF_ERROR(baked);
  PrintNotes(*baked);
  return {};
}

// Lets all skin share an atlas of wrinkle maps, and all cloth another.
void TileAtlases(const authoring::ArkitFace& face, const rig::SkeletonMaps& maps,
                 character::Character* character) {
  int first = authoring::MarkFace(face, character);
  if (first < 0) {
    first = authoring::HeadMaterial(*character, authoring::FindJoints(character->skeleton, maps));
  }
  for (const bool cloth : {false, true}) {
    const auto tiles = authoring::TileAtlas(cloth, cloth ? -1 : first, character);
    if (!tiles.empty()) PrintNotes({authoring::DescribeTiles(tiles, cloth)});
  }
}

// Attaches the requested rig, or a proposed one.
Status AttachRigTo(const ImportArguments& arguments, const rig::SkeletonMaps& maps,
                   authoring::ImportedModel* imported) {
  character::Character* character = &imported->character;
  if (!arguments.rig.empty()) {
    auto rig = LoadRigArgument(arguments.rig, arguments.poses, arguments.map);
    FURROW_RETURN_IF_ERROR(rig);
    return character::AttachRig(std::move(*rig), ResolveRigPath(arguments.rig).parent_path(),
                                character);
  }
  const authoring::ArkitFace face(*character, arguments.model.shapes);
  TileAtlases(face, maps, character);
  const bool shapes = authoring::HasShapeFace(face);
  auto proposal = ProposeFromDefault(character->skeleton, arguments.map,
                                     shapes ? ProposalPart::kBody : ProposalPart::kBodyAndFace,
                                     {character->meshes, imported->look_at}, character->roles);
  if (proposal.ok()) {
    PrintNotes(proposal->remarks);
    FURROW_RETURN_IF_ERROR(
        character::AttachRig(std::move(proposal->rig), character->folder, character));
  } else if (proposal.status().code() != StatusCode::kNotFound) {
    return proposal.status();
  } else if (!shapes) {
    PrintWarnings({"no rig could be proposed: " + proposal.status().ToString()});
  }
  return shapes ? AddFaceOfShapes(arguments, face, character) : Status();
}

int ImportFile(ImportArguments arguments) {
  CatchInterrupts();
  auto shapes = LoadShapeMatcher({});
  if (!shapes.ok()) return Fail(shapes.status());
  arguments.model.shapes = std::move(*shapes);
  const auto maps = rig::SkeletonMaps::Load(arguments.map);
  if (!maps.ok()) return Fail(maps.status());
  auto imported = authoring::ImportModel(arguments.in, *maps, arguments.model);
  if (!imported.ok()) return Fail(imported.status());
  character::Character& character = imported->character;
  PrintNotes(imported->remarks);
  PrintWarnings(imported->warnings);
  if (Status status = AttachRigTo(arguments, *maps, &*imported); !status.ok()) return Fail(status);
  const Status written = character.rig.drivers.empty()
                             ? character::SaveCharacterGlb(character, arguments.out)
                             : authoring::WriteCharacterPackage(character, arguments.out);
  if (!written.ok()) return Fail(written);
  std::size_t vertices = 0;
  std::size_t triangles = 0;
  for (const character::Mesh& mesh : character.meshes) {
    vertices += mesh.vertices.size();
    triangles += mesh.indices.size() / 3;
  }
  if (!character.material_binds.empty()) {
    PrintNotes({Counted(character.material_binds.size(), "change") +
                " of materials by shapes, such as '" +
                character.shapes[character.material_binds.front().shape] + "'"});
  }
  std::fprintf(stderr, "furrow: %s: %s, %s, %s, %s, %s, %s\n", arguments.out.c_str(),
               Counted(character.skeleton.num_joints(), "joint").c_str(),
               Counted(vertices, "vertex", "vertices").c_str(),
               Counted(triangles, "triangle").c_str(),
               Counted(character.shapes.size(), "shape").c_str(),
               Counted(character.rig.drivers.size(), "driver").c_str(),
               Counted(character.rig.regions.size(), "region").c_str());
  return kDone;
}

// Options that the input would ignore.
Status CheckOptions(const ImportArguments& arguments, bool is_save, bool is_folder) {
  if (is_save && !arguments.makehuman.clothes.empty())
    return {StatusCode::kInvalidArgument, "--clothes does not apply to a .mhm file", arguments.in,
            "the file names the clothes itself"};
  if (!is_save && !arguments.data_folders.empty())
    return {StatusCode::kInvalidArgument, "--data applies to .mhm files only", arguments.in};
  if (!is_save && !is_folder && !arguments.makehuman.clothes.empty())
    return {StatusCode::kInvalidArgument, "--clothes applies to MakeHuman's folder only",
            arguments.in, "a model has its clothes itself"};
  return {};
}

// The import takes long, so a package that cannot be written ends it before.
Status CheckOutput(const std::string& out) {
  FURROW_RETURN_IF_ERROR(CheckWritable(out));
  return CheckWritable(character::RigBeside(out));
}

// A validator of CLI11: an empty text means that the value is valid.
std::string CheckPackageName(std::string& name) {
  const bool is_package = std::filesystem::path(name).extension() == ".glb";
  return is_package ? std::string() : "'" + name + "' does not end with .glb";
}

int Import(const ImportArguments& arguments) {
  const std::filesystem::path in(arguments.in);
  std::error_code error;
  const bool is_save = EqualsIgnoreCase(in.extension().string(), ".mhm");
  const bool is_folder = std::filesystem::is_directory(in, error);
  if (const Status status = CheckOptions(arguments, is_save, is_folder); !status.ok()) {
    return Fail(status);
  }
  if (const Status status = CheckOutput(arguments.out); !status.ok()) return Fail(status);
  if (is_folder) return ImportFolder(in, arguments, arguments.makehuman);
  return is_save ? ImportSave(arguments) : ImportFile(arguments);
}

}  // namespace

void AddCharacterImport(CLI::App& group, Action& action) {
  auto arguments = std::make_shared<ImportArguments>();
  CLI::App* command = group.add_subcommand(
      "import",
      "Make a character package from a skinned model (glTF, VRM, FBX, Collada, ...), from a "
      "person that MakeHuman saved (.mhm), or from MakeHuman's data folder");
  command
      ->add_option(
          "IN", arguments->in,
          "Model file, .mhm file, or the MakeHuman folder with 3dobjs/, rigs/, poseunits/ and "
          "clothes/")
      ->required();
  command
      ->add_option("--out", arguments->out,
                   "Package to write, FILE.glb; FILE.rig.json is written beside it")
      ->required()
      ->check(CLI::Validator(CheckPackageName, ""));
  command->add_option(
      "--rig", arguments->rig,
      "Wrinkle rig for the package, by file or shipped name (default: a rig proposed "
      "from the joints and the blend shapes; for MakeHuman, the shipped rig makehuman)");
  command->add_option("--map", arguments->map,
                      "Skeleton map of the joint names, by name or file (default: the best match)");
  command->add_flag("--repair", arguments->model.repair,
                    "Bind unskinned vertices like their neighbours");
  command
      ->add_option("--scale", arguments->model.scale,
                   "Metres per unit of the model (default: derived from its height)")
      ->check(Within(1e-6, 1e6));
  command->add_option("--clothes", arguments->makehuman.clothes,
                      "MakeHuman's folder: garment in clothes/ (default: the first by name)");
  command->add_option("--data", arguments->data_folders,
                      "Data folder of MakeHuman for a .mhm file (repeatable; default: near the "
                      "file or in FURROW_ASSET_PATH)");
  command
      ->add_option(
          "--texture-size", arguments->makehuman.texture_size,
          "Texels per side of the textures that the import paints: MakeHuman's, and the masks "
          "and wrinkle maps of a face of blend shapes")
      ->check(CLI::Range(64, 4096))
      ->capture_default_str();
  command
      ->add_option(
          "--depth", arguments->depth,
          "Factor for the depth of the skin's folds, for a character with a face of blend shapes: "
          "below 1 for smooth skin, above 1 for old skin. A face that is short below its eyes, "
          "as a child's or a cartoon's, has shallow folds at 1, too")
      ->check(CLI::Range(0.0f, 4.0f))
      ->capture_default_str();
  AddBvhOptions(*command, arguments->poses);
  command->callback([arguments, &action] { action = [arguments] { return Import(*arguments); }; });
}

}  // namespace furrow::cli

// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>

#include "base/files.h"
#include "character/package/package.h"
#include "character/package/rig_report.h"
#include "client/cli/commands/commands.h"
#include "client/cli/common/exit_code.h"
#include "client/cli/common/helper_program.h"
#include "client/cli/common/inputs.h"
#include "client/cli/output/explanation_text.h"
#include "gltf/limits.h"
#include "motion/clip/clip.h"
#include "rig/exports/export_profile.h"
#include "rig/near_names.h"
#include "rig/rig_file.h"
#include "wrinkle/solver/solver.h"

namespace furrow::cli {
namespace {

struct RigOptions {
  std::string rig;
  std::string file;  // a recording; `check` uses its skeleton only
  std::string skeleton_map;
  std::string shape_map;
  std::string out;
  std::vector<std::string> profiles;  // of exports
  motion::LoadOptions read;
  int frame = 0;
  float threshold = 0.01f;
};

constexpr char kRigHelp[] =
    "Wrinkle rig: a JSON file, the name of a shipped rig, or a character (.glb, or a shipped name)";

int Explain(const RigOptions& options) {
  const auto input = LoadRigInput(options.rig, options.read, options.skeleton_map);
  if (!input.ok()) return Fail(input.status());
  const wrinkle::Rig& rig = input->rig;
  const auto clip = LoadClipArgument(options.file, options.read);
  if (!clip.ok()) return Fail(clip.status());
  if (options.frame >= clip->num_frames()) {
    return Fail({StatusCode::kInvalidArgument,
                 "there is no frame " + std::to_string(options.frame) +
                     "; the recording has frames 0 to " + std::to_string(clip->num_frames() - 1),
                 options.file});
  }
  const auto matcher = LoadSkeletonMatcher(options.skeleton_map, input->character.get());
  if (!matcher.ok()) return Fail(matcher.status());
  const auto match = MatchJoints(*matcher, *clip, rig, input->skeleton());
  const auto shape_matcher = LoadShapeMatcher(options.shape_map);
  if (!shape_matcher.ok()) return Fail(shape_matcher.status());
  const rig::RigShapes shapes =
      MatchBlendShapes(*shape_matcher, *clip, rig,
                       MatchFaceJoints(*shape_matcher, *clip, match, input->character.get()));
  const auto binding = wrinkle::RigBinding::Create(rig, clip->skeleton, shapes.driver_names(),
                                                   match.Options(/*allow_missing=*/true));
  if (!binding.ok()) return Fail(binding.status().At(options.rig));
  WarnAboutMissing(*binding, *clip);
  wrinkle::LocalPose pose;
  clip->GetPose(options.frame, &pose);
  shapes.Extend(&pose);
  wrinkle::Explanation explanation;
  if (wrinkle::Explain(*binding, pose, &explanation) != wrinkle::JobStatus::kOk) {
    return Fail({StatusCode::kInternal, "the frame could not be explained", options.file});
  }
  std::printf("%s, frame %d, without filter\n", options.file.c_str(), options.frame);
  PrintExplanation(explanation, options.threshold, stdout);
  return kDone;
}

// The profiles of --export: shipped ones, files, and those that only the rig has.
Result<std::vector<rig::ExportProfile>> LoadProfiles(const std::vector<std::string>& names,
                                                     const wrinkle::Rig& rig) {
  std::vector<rig::ExportProfile> profiles;
  for (const std::string& name : names) {
    auto profile = rig::LoadExportProfile(name);
    if (profile.ok()) {
      profiles.push_back(std::move(*profile));
    } else if (std::ranges::find(rig.exports, name, &wrinkle::Export::profile) !=
               rig.exports.end()) {
      profiles.push_back({name, "of the rig alone", {}});
    } else {
      return profile.status().At("--export");
    }
  }
  return profiles;
}

// The names of the pictures in a character package.
Result<std::vector<std::string>> PicturesIn(const std::filesystem::path& package) {
  const auto bytes = ReadFile(package, gltf::kMaxFileBytes);
  FURROW_RETURN_IF_ERROR(bytes);
  const auto parsed = character::ParseCharacter(*bytes, package.parent_path(),
                                                {.pictures = character::Pictures::kStandIns});
  if (!parsed.ok()) return parsed.status().Within(package.string());
  std::vector<std::string> names;
  for (const character::Picture& picture : parsed->pictures) names.push_back(picture.name);
  return names;
}

// A rig to check.
struct CheckedRig {
  wrinkle::Rig rig;
  std::filesystem::path folder;       // of the rig's pictures
  std::vector<std::string> embedded;  // names of the pictures in the rig's character
};

// Loads a rig, or the rig beside a character package. Prints which recordings are missing.
Result<CheckedRig> LoadCheckedRig(const RigOptions& options) {
  CheckedRig checked;
  const std::filesystem::path package = FindPackageArgument(options.rig);
  std::filesystem::path file = ResolveRigPath(options.rig);
  if (!package.empty()) {
    auto pictures = PicturesIn(package);
    FURROW_RETURN_IF_ERROR(pictures);
    checked.embedded = *std::move(pictures);
    file = character::RigBeside(package);
    std::error_code error;
    if (!std::filesystem::exists(file, error)) return CharacterWithoutRig(package.string());
  }
  const auto poses = RigPoses(options.read, options.skeleton_map, package);
  FURROW_RETURN_IF_ERROR(poses);
  // The rig that ships for MakeHuman names a recording of MakeHuman, which does not ship. Only
  // binding to a skeleton needs the poses.
  std::set<std::string> missing;
  auto rig = rig::LoadRig(file, *poses, options.file.empty() ? &missing : nullptr);
  FURROW_RETURN_IF_ERROR(rig);
  for (const std::string& name : missing) {
    PrintWarnings({"the recording '" + name +
                   "' was not found, so the poses taken from it are not "
                   "checked; put it beside the rig or add its folder to FURROW_ASSET_PATH"});
  }
  checked.rig = *std::move(rig);
  checked.folder = file.parent_path();
  return checked;
}

int Check(const RigOptions& options) {
  const auto checked = LoadCheckedRig(options);
  if (!checked.ok()) return Fail(checked.status());
  const wrinkle::Rig& rig = checked->rig;
  const auto profiles = LoadProfiles(options.profiles, rig);
  if (!profiles.ok()) return Fail(profiles.status());
  character::RigReportOptions report_options;
  report_options.folder = checked->folder;
  report_options.embedded_pictures = checked->embedded;
  std::optional<motion::Clip> clip;
  rig::RigShapes shapes;
  if (!options.file.empty()) {
    auto loaded = LoadClipArgument(options.file, options.read);
    if (!loaded.ok()) return Fail(loaded.status());
    clip = std::move(*loaded);
    report_options.skeleton = &clip->skeleton;
    const auto shape_matcher = LoadShapeMatcher(options.shape_map);
    if (!shape_matcher.ok()) return Fail(shape_matcher.status());
    shapes = MatchBlendShapes(*shape_matcher, *clip, rig);
    report_options.blend_shape_names = shapes.driver_names();
  }
  rig::SkeletonMatch match;
  if (clip) {
    const auto matcher = LoadSkeletonMatcher(options.skeleton_map);
    if (!matcher.ok()) return Fail(matcher.status());
    match = MatchJoints(*matcher, *clip, rig);
    report_options.aliases = match.aliases;
    report_options.role_chains = match.role_chains;
    report_options.turn = match.turn();
  }
  const character::RigReport report = character::ReportOnRig(rig, report_options);
  std::fputs(character::ToText(report).c_str(), stdout);
  for (const rig::ExportProfile& profile : *profiles) {
    std::fputs(rig::ToText(rig::CoverExports(rig, profile)).c_str(), stdout);
  }
  return report.binding.ok() ? kDone : Fail(report.binding.At(options.rig));
}

int ProposeMap(const RigOptions& options) {
  const auto clip = LoadClipArgument(options.file, options.read);
  if (!clip.ok()) return Fail(clip.status());
  const auto matcher = LoadSkeletonMatcher({});
  if (!matcher.ok()) return Fail(matcher.status());
  rig::SkeletonRoles roles = matcher->RolesOf(clip->skeleton);
  if (roles.map.empty() || roles.map == rig::kFromHierarchy) {
    const auto shipped = rig::SkeletonMaps::LoadShipped();
    if (!shipped.ok()) return Fail(shipped.status());
    auto near = rig::RolesOfNearNames(shipped->maps(), clip->skeleton.joint_names());
    if (near.num_roles > roles.num_roles) roles = std::move(near);
  }
  if (clip->skeleton.num_joints() == 0 || roles.roles.empty()) {
    return Fail({StatusCode::kUnsupported,
                 "no roles were found: no skeleton map fits, and the hierarchy is not that of an "
                 "upright body",
                 options.file, "write the map by hand (docs/SKELETONS.md)"});
  }
  const std::string name = std::filesystem::path(options.out).stem().string();
  const std::string map = rig::ProposeSkeletonMap(name, clip->skeleton.joint_names(), roles.roles);
  if (Status status = WriteFileAtomically(options.out, map); !status.ok()) return Fail(status);
  std::fprintf(stderr, "furrow: %s: %s; check the joints, then use --skeleton-map %s\n",
               options.out.c_str(), rig::Describe(roles).c_str(), options.out.c_str());
  return kDone;
}

void AddProposeMap(CLI::App& group, Action& action) {
  auto options = std::make_shared<RigOptions>();
  CLI::App* command = group.add_subcommand(
      "propose-map", "Write a skeleton map for a recording, as a start for your own");
  command->add_option("FILE", options->file, "Recording with the skeleton")->required();
  command->add_option("--out", options->out, "File to write (.json)")->required();
  AddReadOptions(*command, options->read);
  command->callback([options, &action] { action = [options] { return ProposeMap(*options); }; });
}

void AddCheck(CLI::App& group, Action& action) {
  auto options = std::make_shared<RigOptions>();
  CLI::App* command = group.add_subcommand("check", "Validate a rig and report likely mistakes");
  command->add_option("RIG", options->rig, kRigHelp)->required();
  command->add_option(
      "--skeleton", options->file,
      "Recording to check the rig's joints and blend shapes against (default: none)");
  command
      ->add_option("--export", options->profiles,
                   "Export profile, by file or shipped name: list which of its names the rig's "
                   "weights cover (repeatable; default: none)")
      ->allow_extra_args(false);
  AddSkeletonMap(*command, options->skeleton_map);
  AddShapeMap(*command, options->shape_map);
  AddReadOptions(*command, options->read);
  command->callback([options, &action] { action = [options] { return Check(*options); }; });
}

void AddExplain(CLI::App& group, Action& action) {
  auto options = std::make_shared<RigOptions>();
  CLI::App* command =
      group.add_subcommand("explain", "Show which driver and pose made each weight of a frame");
  command->add_option("RIG", options->rig, kRigHelp)->required();
  command
      ->add_option("FILE", options->file,
                   "Recording: BVH, glTF/GLB, VRMA, FBX, Collada, Live Link Face CSV or a take")
      ->required();
  AddSkeletonMap(*command, options->skeleton_map);
  AddShapeMap(*command, options->shape_map);
  AddReadOptions(*command, options->read);
  command->add_option("--frame", options->frame, "Frame number, counted from 0")
      ->check(Within(0, 1e9))
      ->capture_default_str();
  command
      ->add_option("--threshold", options->threshold,
                   "Smallest weight to list; smaller weights are counted only")
      ->check(Within(0.0, 1.0))
      ->capture_default_str();
  command->callback([options, &action] { action = [options] { return Explain(*options); }; });
}

}  // namespace

void AddRig(CLI::App& app, Action& action) {
  CLI::App* group =
      app.add_subcommand("rig", "Check wrinkle rigs, explain their weights and cut patches");
  group->require_subcommand(1);
  AddCheck(*group, action);
  AddProposeMap(*group, action);
  AddExplain(*group, action);
  AddHelperEntry(*group, "rig patch");
}

}  // namespace furrow::cli

// SPDX-License-Identifier: Apache-2.0
#include "client/cli/common/inputs.h"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <span>
#include <utility>

#include "base/data_dir.h"
#include "base/status.h"
#include "base/text.h"
#include "character/mesh/moved_surface.h"
#include "character/package/package.h"
#include "client/cli/common/progress.h"
#include "motion/clip_file.h"
#include "motion/find_recording.h"
#include "motion/pose_source.h"
#include "recording/take_clip.h"
#include "rig/poses_in_axes.h"
#include "rig/rig_file.h"
#include "rig/shapes/face_joints.h"

namespace furrow::cli {

namespace fs = std::filesystem;

namespace {

void PrintWarning(const std::string& text) {
  std::fprintf(stderr, "furrow: warning: %s\n", text.c_str());
}

}  // namespace

void PrintWarnings(const std::vector<std::string>& warnings) {
  std::ranges::for_each(warnings, PrintWarning);
}

recording::ReadProgress ReadingBar() {
  return
      // Shared, because std::function copies its target. The bar appears with the first call and is
      // erased with the last.
      [bar = std::make_shared<std::optional<Progress>>()](std::uint64_t done, std::uint64_t total) {
        if (done >= total) return bar->reset();
        if (!*bar) bar->emplace("reading", static_cast<std::int64_t>(total));
        (*bar)->Set(static_cast<std::int64_t>(done));
      };
}

Result<std::unique_ptr<recording::TakeReader>> OpenTakeArgument(const std::string& path,
                                                                std::string* subject) {
  std::string file;
  recording::SplitTakePath(path, &file, subject);
  auto take = recording::TakeReader::Open(file);
  if (take.ok()) (*take)->set_progress(ReadingBar());
  return take;
}

Result<motion::Clip> LoadClipArgument(const std::string& path, const motion::LoadOptions& options,
                                      motion::ClipReport* result) {
  const auto file = motion::FindRecording(path);
  FURROW_RETURN_IF_ERROR(file);
  motion::ClipReport report;
  auto clip = recording::IsTakePath(path)
                  ? recording::LoadTakeClip(path, options.scale, &report, ReadingBar())
                  : motion::LoadClip(*file, options, &report);
  PrintWarnings(report.warnings);
  if (result != nullptr) *result = std::move(report);
  return clip;
}

fs::path ResolveRigPath(const std::string& argument) { return rig::FindRigFile(argument); }

Result<wrinkle::PoseSource> RigPoses(const motion::LoadOptions& read,
                                     const std::string& skeleton_map, const fs::path& package) {
  motion::LoadOptions options = read;
  options.rest_frame = -1;  // poses state one of their own
  if (!skeleton_map.empty()) {
    const auto chosen = rig::SkeletonMatcher::Create(skeleton_map);
    if (!chosen.ok()) return chosen.status().At("skeleton map");
  }
  const auto make_matcher = [skeleton_map, package] {
    // LoadSkeletonMatcher() warns if there are no shipped maps, and loading the package reports its
    // faults.
    auto found = rig::SkeletonMatcher::Create(skeleton_map);
    rig::SkeletonMatcher matcher = found.ok() ? *std::move(found) : rig::SkeletonMatcher();
    if (package.empty()) return matcher;
    const auto roles = character::LoadCharacterRoles(package);
    if (roles.ok()) matcher.SetCharacterRoles(*roles);
    return matcher;
  };
  return rig::PosesInFurrowAxes(motion::CachedPoseSource(options, PrintWarning), make_matcher,
                                PrintWarning);
}

Result<wrinkle::Rig> LoadRigArgument(const std::string& argument, const motion::LoadOptions& read,
                                     const std::string& skeleton_map) {
  const auto poses = RigPoses(read, skeleton_map);
  FURROW_RETURN_IF_ERROR(poses);
  return rig::LoadRig(ResolveRigPath(argument), *poses);
}

Result<rig::SkeletonMatcher> LoadSkeletonMatcher(const std::string& map,
                                                 const character::Character* character) {
  auto matcher = rig::SkeletonMatcher::Create(map);
  if (matcher.ok() && character != nullptr) {
    matcher->SetCharacterRoles(character->skeleton, character->roles);
  }
  if (matcher.ok()) return matcher;
  // A map that the user asks for must exist; the shipped ones are optional.
  if (!map.empty()) return matcher.status().At("--skeleton-map");
  PrintWarnings({"joints are matched by equal names only: " + matcher.status().ToString()});
  return rig::SkeletonMatcher();
}

Result<rig::ShapeMatcher> LoadShapeMatcher(const std::string& map) {
  auto matcher = rig::ShapeMatcher::Create(map);
  if (matcher.ok()) return matcher;
  if (!map.empty()) return matcher.status().At("--shape-map");
  PrintWarnings({"blend shapes are matched by equal names only: " + matcher.status().ToString()});
  return rig::ShapeMatcher();
}

void PrintMatch(const rig::SkeletonMatch& match) {
  const std::string text = rig::Describe(match);
  // To standard error, because commands write their results to standard output.
  if (!text.empty()) std::fprintf(stderr, "furrow: %s\n", text.c_str());
  PrintWarnings(rig::WarningsOf(match));
}

void PrintMatchesOf(std::span<const wrinkle::Skeleton> skeletons) {
  const auto has_joints = [](const wrinkle::Skeleton& s) { return s.num_joints() > 0; };
  if (std::ranges::none_of(skeletons, has_joints)) return;
  const auto matcher = LoadSkeletonMatcher({});
  if (!matcher.ok()) return;
  for (const wrinkle::Skeleton& skeleton : skeletons) {
    // Without a rig, the match has the roles and the axes alone.
    if (has_joints(skeleton)) PrintMatch(matcher->Match(skeleton, wrinkle::Rig(), nullptr));
  }
}

rig::SkeletonMatch MatchJoints(const rig::SkeletonMatcher& matcher, const motion::Clip& clip,
                               const wrinkle::Rig& rig, const wrinkle::Skeleton* character) {
  rig::SkeletonMatch match = matcher.Match(clip.skeleton, rig, character);
  PrintMatch(match);
  return match;
}

rig::RigShapes MatchBlendShapes(const rig::ShapeMatcher& matcher, const motion::Clip& clip,
                                const wrinkle::Rig& rig, const rig::JointMovedShapes& moved) {
  rig::RigShapes shapes(matcher, clip.blend_shape_names, rig, moved);
  const std::string text = shapes.Description();
  // To standard error, because commands write their results to standard output.
  if (!text.empty()) std::fprintf(stderr, "furrow: %s\n", text.c_str());
  return shapes;
}

rig::JointMovedShapes MatchFaceJoints(const rig::ShapeMatcher& matcher, const motion::Clip& clip,
                                      const rig::SkeletonMatch& match,
                                      const character::Character* character) {
  if (character == nullptr || character->shapes.empty()) return {};
  const bool has_own =
      !rig::MatchShapes(matcher, clip.blend_shape_names, character->shapes).empty();
  if (has_own) return {};
  const auto retarget = rig::MakeRetarget(match, clip.skeleton, character->skeleton);
  auto found = rig::MatchFaceJoints(
      {clip.skeleton, match.stream.roles, match.turn(), retarget.unmatched_source()},
      {character->skeleton, match.character.roles, character::FindMovedSurface(character->meshes),
       character->shapes, character->shape_rules},
      matcher);
  if (found.empty()) return {};
  std::fprintf(stderr, "furrow: %s\n", found.Description().c_str());
  return {std::make_shared<const wrinkle::JointShapes>(std::move(found)), character->shapes};
}

void WarnAboutMissing(const wrinkle::RigBinding& binding, const motion::Clip& clip) {
  static constexpr std::size_t kNamed = 4;
  const auto warn = [](std::span<const std::string> names, const std::string& one) {
    if (names.empty()) return;
    std::string text = "the recording lacks " + Counted(names.size(), one) +
                       " of the rig, and their drivers stay at 0: " + names[0];
    for (std::size_t i = 1; i < std::min(names.size(), kNamed); ++i) text += ", " + names[i];
    PrintWarnings({text + (names.size() > kNamed ? ", ..." : "")});
  };
  // A recording of a face has no joints, and one of a body no blend shapes; nothing is missing.
  if (clip.skeleton.num_joints() > 0) warn(binding.missing_joints(), "joint");
  if (!clip.blend_shape_names.empty()) warn(binding.missing_blend_shapes(), "blend shape");
}

fs::path FindPackageArgument(const std::string& argument) {
  fs::path package = character::FindCharacterFile(argument);
  if (fs::path(argument).extension() == ".glb") return package;
  std::error_code error;
  const bool is_rig = fs::exists(ResolveRigPath(argument), error);
  return is_rig || package.extension() != ".glb" ? fs::path() : package;
}

Status CharacterWithoutRig(const std::string& argument) {
  return {StatusCode::kNotFound, "the character has no wrinkle rig", argument,
          "write one with 'furrow character propose-rig', or choose a rig file"};
}

Result<RigInput> LoadRigInput(const std::string& argument, const motion::LoadOptions& read,
                              const std::string& skeleton_map) {
  RigInput input;
  if (FindPackageArgument(argument).empty()) {
    auto rig = LoadRigArgument(argument, read, skeleton_map);
    FURROW_RETURN_IF_ERROR(rig);
    input.rig = *std::move(rig);
    return input;
  }
  auto character = LoadCharacterArgument(argument, {}, read, skeleton_map);
  FURROW_RETURN_IF_ERROR(character);
  if (character->rig.drivers.empty()) return CharacterWithoutRig(argument);
  input.rig = character->rig;
  input.character = std::make_unique<const character::Character>(*std::move(character));
  return input;
}

Result<character::Character> LoadCharacterArgument(const std::string& glb, const std::string& rig,
                                                   const motion::LoadOptions& read,
                                                   const std::string& skeleton_map) {
  fs::path package;
  if (glb.empty()) {
    const auto shipped = furrow::FindDataFile("default.glb");
    FURROW_RETURN_IF_ERROR(shipped);
    package = *shipped;
  } else {
    package = character::FindCharacterFile(glb);
  }
  const auto poses = RigPoses(read, skeleton_map, package);
  FURROW_RETURN_IF_ERROR(poses);
  auto character =
      character::LoadCharacter(package, rig.empty() ? fs::path() : ResolveRigPath(rig), *poses);
  if (!character.ok()) return character;
  PrintWarnings(character->warnings);
  for (const std::string& name : character->missing_rig_pictures) {
    PrintWarnings(
        {"the rig's picture '" + name + "' was not found; wrinkles that need it are not drawn"});
  }
  return character;
}

}  // namespace furrow::cli

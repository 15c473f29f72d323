// SPDX-License-Identifier: Apache-2.0
#include "server/assets.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <spdlog/spdlog.h>

#include "base/data_dir.h"
#include "base/status.h"
#include "character/mesh/moved_surface.h"
#include "character/package/package.h"
#include "character/package/web_package.h"
#include "motion/pose_source.h"
#include "render/settings/settings_file.h"
#include "rig/poses_in_axes.h"
#include "rig/rig_file.h"
#include "server/session/subscriptions/view_settings.h"
#include "wrinkle/rig/rig_blend_shapes.h"

namespace furrow::server {

namespace {

namespace fs = std::filesystem;

// The rig of a character: the one given, or the one beside the character, as in LoadCharacter().
// Empty if there is neither, or no character.
fs::path RigOf(const fs::path& character, const fs::path& rig) {
  std::error_code error;
  if (!fs::exists(character, error)) return {};
  if (!rig.empty()) return rig;
  fs::path beside = character::RigBeside(character);
  return fs::exists(beside, error) ? beside : fs::path();
}

// Sets `assets->rig` from a rig file, without any mesh.
Status LoadRigAlone(const fs::path& path, const wrinkle::PoseSource& poses, Assets* assets) {
  auto rig = rig::LoadRig(path, poses);
  if (rig.ok()) assets->rig = std::make_shared<const wrinkle::Rig>(*std::move(rig));
  return rig.status();
}

// Null if nothing is drawn and the rig reads no shapes.
std::shared_ptr<const CharacterShapes> ShapesOf(const character::Character& character, bool draws) {
  const bool reads = !wrinkle::BlendShapesOf(character.rig).empty();
  if (!draws && (character.shapes.empty() || !reads)) return nullptr;
  return std::make_shared<const CharacterShapes>(
      CharacterShapes{character.skeleton, character.shapes, character.shape_rules,
                      character::FindMovedSurface(character.meshes)});
}

// Shipped maps are optional; only a map that the user asks for must exist.
Result<rig::SkeletonMatcher> LoadMatcher(const std::string& map) {
  auto matcher = rig::SkeletonMatcher::Create(map);
  if (matcher.ok() || !map.empty()) return matcher;
  spdlog::warn("joints are matched by equal names only: {}", matcher.status().ToString());
  return rig::SkeletonMatcher();
}

Result<rig::ShapeMatcher> LoadShapeMaps(const std::string& map) {
  auto matcher = rig::ShapeMatcher::Create(map);
  if (matcher.ok() || !map.empty()) return matcher;
  spdlog::warn("blend shapes are matched by equal names only: {}", matcher.status().ToString());
  return rig::ShapeMatcher();
}

// True if streams, shapes and wrinkle weights of one fit the other, which may be null.
bool DrawsTheSame(const character::Character* one, const character::Character& other) {
  return one != nullptr && one->skeleton.hash() == other.skeleton.hash() &&
         one->shapes == other.shapes &&
         std::ranges::equal(one->rig.regions, other.rig.regions, {}, &wrinkle::Region::name,
                            &wrinkle::Region::name);
}

// Loads the maps of names and the settings of pictures, which need no character.
Status LoadMapsAndSettings(const Config& config, Assets* assets) {
  auto matcher = LoadMatcher(config.skeleton_map);
  if (!matcher.ok()) return matcher.status().At("--skeleton-map");
  assets->skeletons = *std::move(matcher);
  auto shapes = LoadShapeMaps(config.shape_map);
  if (!shapes.ok()) return shapes.status().At("--shape-map");
  assets->shape_matcher = *std::move(shapes);
  assets->settings = DefaultSettings();
  if (config.render_settings.empty()) return {};
  return render::LoadSettings(config.render_settings, &assets->settings).At("--render-settings");
}

// The file of the character that `config` names, or of the default one.
Result<fs::path> CharacterFileOf(const Config& config) {
  if (!config.character.empty()) return character::FindCharacterFile(config.character);
  auto shipped = furrow::FindDataFile("default.glb");
  if (shipped.ok()) return shipped;
  return Status(StatusCode::kNotFound, "there is no default character", shipped.status().where(),
                shipped.status().todo() + ", or use --character or --rig");
}

// Loads a character into `assets`. `chosen_rig`: replaces its rig; empty: its own.
Status LoadCharacterOf(const Config& config, const fs::path& glb, const fs::path& chosen_rig,
                       const wrinkle::PoseSource& poses, character::Pictures pictures,
                       Assets* assets) {
  if (pictures == character::Pictures::kLoad) {
    spdlog::info("loading the character {}", glb.string());
  }
  if (!config.render) pictures = character::Pictures::kLeaveOut;
  assets->lacks_pictures = pictures == character::Pictures::kLeaveOut;
  auto loaded = character::LoadCharacter(glb, chosen_rig, poses, pictures);
  FURROW_RETURN_IF_ERROR(loaded);
  assets->skeletons.SetCharacterRoles(loaded->skeleton, loaded->roles);
  assets->shapes = ShapesOf(*loaded, config.render);
  if (!config.render) {
    assets->rig = std::make_shared<const wrinkle::Rig>(std::move(loaded->rig));
    return {};
  }
  // A copy, because weights go on when the character is gone.
  assets->rig = std::make_shared<const wrinkle::Rig>(loaded->rig);
  assets->character = std::make_shared<const character::Character>(*std::move(loaded));
  if (chosen_rig.empty()) assets->package = glb;
  return {};
}

}  // namespace

Result<Assets> LoadAssets(const Config& config, character::Pictures pictures) {
  const fs::path chosen_rig = config.rig.empty() ? fs::path() : rig::FindRigFile(config.rig);
  Assets assets;
  FURROW_RETURN_IF_ERROR(LoadMapsAndSettings(config, &assets));
  // Rigs name the files and frames of their reference poses; each file is read once.
  const auto warn = [](const std::string& warning) { spdlog::warn("{}", warning); };
  const wrinkle::PoseSource files = motion::CachedPoseSource(ReadOptions(config), warn);
  if (config.character.empty() && !config.rig.empty()) {
    const auto poses = rig::PosesInFurrowAxes(files, assets.skeletons, warn);
    FURROW_RETURN_IF_ERROR(LoadRigAlone(chosen_rig, poses, &assets));
    return assets;
  }
  const Result<fs::path> glb = CharacterFileOf(config);
  FURROW_RETURN_IF_ERROR(glb);
  const fs::path rig = RigOf(*glb, chosen_rig);
  const auto make_matcher = [maps = assets.skeletons, glb = *glb] {
    rig::SkeletonMatcher with_roles = maps;
    // Loading the character reports faults.
    const auto roles = character::LoadCharacterRoles(glb);
    if (roles.ok()) with_roles.SetCharacterRoles(*roles);
    return with_roles;
  };
  const auto poses = rig::PosesInFurrowAxes(files, make_matcher, warn);
  // Weights need no mesh and no pictures, which are large, unless joints may move shapes.
  if (!config.render && !rig.empty()) {
    FURROW_RETURN_IF_ERROR(LoadRigAlone(rig, poses, &assets));
    if (wrinkle::BlendShapesOf(*assets.rig).empty()) {
      // Weights are the same with and without pictures, so they need the roles that the package
      // states for the rig's joints.
      const auto roles = character::LoadCharacterRoles(*glb);
      FURROW_RETURN_IF_ERROR(roles);
      assets.skeletons.SetCharacterRoles(*roles);
      return assets;
    }
  }
  FURROW_RETURN_IF_ERROR(LoadCharacterOf(config, *glb, chosen_rig, poses, pictures, &assets));
  return assets;
}

Result<Assets> LoadWithPictures(const Config& config, const character::Character& former,
                                character::Pictures pictures) {
  auto assets = LoadAssets(config, pictures);
  FURROW_RETURN_IF_ERROR(assets);
  if (!DrawsTheSame(assets->character.get(), former)) {
    return Status(StatusCode::kUnavailable,
                  "the files of the character have changed since the daemon started", "",
                  "restart it");
  }
  return assets;
}

fs::path FindWebPackage(const fs::path& package) {
  const fs::path packed = character::WebPackageBeside(package);
  std::error_code error;
  if (!fs::exists(packed, error)) return {};
  const Status status = character::CheckWebPackage(packed, package);
  if (status.ok()) return packed;
  spdlog::warn("browsers do not draw the character: {}", status.ToString());
  return {};
}

}  // namespace furrow::server

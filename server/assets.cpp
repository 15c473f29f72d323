// SPDX-License-Identifier: Apache-2.0
#include "server/assets.h"

#include <cstdlib>
#include <system_error>
#include <utility>

#include "character/rig_file.h"
#include "motion/pose_source.h"

namespace furrow::server {

std::filesystem::path DataFolder() {
  if (const char* folder = std::getenv("FURROW_DATA_DIR"); folder != nullptr && *folder != '\0') {
    return folder;
  }
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  return program.parent_path() / ".." / "share" / "furrow";
}

Result<Assets> LoadAssets(const Config& config) {
  const wrinkle::PoseSource poses = motion::CachedPoseSource();
  Assets assets;
  if (config.character.empty() && !config.rig.empty()) {
    auto rig = character::LoadRig(config.rig, poses);
    if (!rig.ok()) return rig.status();
    assets.rig = std::make_shared<const wrinkle::Rig>(*std::move(rig));
    return assets;
  }
  std::filesystem::path glb = config.character;
  if (glb.empty()) {
    glb = (DataFolder() / "default.glb").lexically_normal();
    if (std::error_code error; !std::filesystem::exists(glb, error)) {
      return Status(StatusCode::kNotFound, "there is no default character", glb.string(),
                    "build the target furrow_share, set FURROW_DATA_DIR, or give --character or "
                    "--rig");
    }
  }
  auto loaded = character::LoadCharacter(glb, config.rig, poses);
  if (!loaded.ok()) return loaded.status();
  auto shared = std::make_shared<const character::Character>(*std::move(loaded));
  assets.rig = std::shared_ptr<const wrinkle::Rig>(shared, &shared->rig);
  assets.character = std::move(shared);
  return assets;
}

}  // namespace furrow::server

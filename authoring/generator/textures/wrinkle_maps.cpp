// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/textures/wrinkle_maps.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "authoring/bake/bake.h"
#include "authoring/bake/bake_pictures.h"
#include "authoring/bake/bake_poses.h"
#include "authoring/paint/strokes.h"
#include "base/status.h"

namespace furrow::authoring {
namespace {

constexpr int kWrinkleNormalBits = 10;  // a tenth of a degree is enough, since folds are smooth
constexpr float kFineLines = 0.8f;      // for skin that folds twice as deep as at 30 years

Status AddPictures(const BakedMap& baked, character::Character* character) {
  const auto& maps = character->rig.wrinkle_maps;
  const auto map = std::find_if(maps.begin(), maps.end(),
                                [&](const auto& entry) { return entry.name == baked.map; });
  if (map == maps.end() || map->normal.empty()) {
    return Status(StatusCode::kNotFound, "no normal map for '" + baked.map + "'",
                  character->rig.name, "add a 'normal' to the wrinkle map in the rig");
  }
  Result<std::vector<character::Picture>> pictures = WrinkleMapPictures(baked, *map);
  FURROW_RETURN_IF_ERROR(pictures);
  for (character::Picture& picture : pictures.value()) {
    if (picture.name == map->normal) RoundNormals(kWrinkleNormalBits, &picture);
    character->rig_pictures.emplace_back(picture.name,
                                         static_cast<int>(character->pictures.size()));
    character->pictures.push_back(std::move(picture));
  }
  return Status();
}

}  // namespace

BakeOptions WrinkleMapOptions(int size, float depth) {
  BakeOptions options;
  options.size = size;
  options.skin.depth = depth;
  options.skin.fine_lines = std::clamp(kFineLines * (depth - 1.0f), 0.0f, 1.0f);
  return options;
}

Status AddWrinkleMaps(std::span<const BakeStroke> strokes, int size, float depth,
                      character::Character* character) {
  Result<CollectedPoses> poses = CollectBakePoses(*character);
  FURROW_RETURN_IF_ERROR(poses);
  Result<BakedMaps> maps =
      Bake(*character, poses.value().poses, strokes, WrinkleMapOptions(size, depth));
  FURROW_RETURN_IF_ERROR(maps);
  for (const BakedMap& map : maps.value().maps) {
    FURROW_RETURN_IF_ERROR(AddPictures(map, character));
  }
  return Status();
}

}  // namespace furrow::authoring

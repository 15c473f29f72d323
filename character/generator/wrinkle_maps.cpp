// SPDX-License-Identifier: Apache-2.0
#include "character/generator/wrinkle_maps.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "character/bake/bake_pictures.h"
#include "character/bake/bake_poses.h"
#include "character/paint/strokes.h"

namespace furrow::character::generator {
namespace {

constexpr int kNormalBits = 10;     // a tenth of a degree: folds are smooth
constexpr float kFineLines = 0.8f;  // of a skin that folds twice as deep as a young man's

Status AddPictures(const bake::BakedMap& baked, Character* character) {
  const auto& maps = character->rig.wrinkle_maps;
  const auto map = std::find_if(maps.begin(), maps.end(),
                                [&](const auto& entry) { return entry.name == baked.map; });
  if (map == maps.end() || map->normal.empty()) {
    return Status(StatusCode::kNotFound, "no normal map is named for '" + baked.map + "'",
                  character->rig.name, "give the wrinkle map a 'normal' in the rig");
  }
  Result<std::vector<Picture>> pictures = bake::PicturesOf(baked, *map);
  if (!pictures.ok()) return pictures.status();
  for (Picture& picture : pictures.value()) {
    if (picture.name == map->normal) paint::RoundNormals(kNormalBits, &picture);
    character->rig_pictures.emplace_back(picture.name,
                                         static_cast<int>(character->pictures.size()));
    character->pictures.push_back(std::move(picture));
  }
  return Status();
}

}  // namespace

bake::BakeOptions WrinkleMapOptions(int size, float depth) {
  bake::BakeOptions options;
  options.size = size;
  options.skin.depth = depth;
  options.skin.fine_lines = std::clamp(kFineLines * (depth - 1.0f), 0.0f, 1.0f);
  return options;
}

Status AddWrinkleMaps(std::span<const bake::BakeStroke> strokes, int size, float depth,
                      Character* character) {
  Result<bake::PosesToBake> poses = bake::PosesOf(*character);
  if (!poses.ok()) return poses.status();
  Result<bake::BakedMaps> maps =
      bake::Bake(*character, poses.value().poses, strokes, WrinkleMapOptions(size, depth));
  if (!maps.ok()) return maps.status();
  for (const bake::BakedMap& map : maps.value().maps) {
    if (Status status = AddPictures(map, character); !status.ok()) return status;
  }
  return Status();
}

}  // namespace furrow::character::generator

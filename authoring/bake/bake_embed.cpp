// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/bake_embed.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "authoring/bake/bake_package.h"
#include "authoring/bake/bake_pictures.h"
#include "authoring/bake/layers/blood.h"
#include "authoring/paint/strokes.h"
#include "base/status.h"

namespace furrow::authoring {
namespace {

constexpr int kNormalBits = 10;  // a tenth of a degree is enough, since folds are smooth

// The names are those that the pictures get if they are free.
void NamePictures(const BakedMap& baked, wrinkle::WrinkleMap* map) {
  map->derivative.clear();
  map->normal = baked.map + "_normal";
  map->height = baked.map + "_height";
  map->height_mm = RoundScale(baked.height_mm, 0.01f);
  map->cavity = baked.map + "_cavity";
  map->colour = baked.cloth ? "" : baked.map + "_colour";
  map->colour_scale = baked.cloth ? 1.0f : kBloodTintScale;
}

Status EmbedMap(const BakedMap& baked, wrinkle::WrinkleMap* map, character::Character* character) {
  NamePictures(baked, map);
  auto pictures = WrinkleMapPictures(baked, *map);
  FURROW_RETURN_IF_ERROR(pictures);
  for (character::Picture& picture : *pictures) {
    if (picture.name == map->normal) RoundNormals(kNormalBits, &picture);
    for (std::string* name : {&map->normal, &map->height, &map->cavity, &map->colour}) {
      if (*name != picture.name) continue;
      *name = AddRigPicture(std::move(picture), character);
      break;
    }
  }
  return {};
}

}  // namespace

std::string AddRigPicture(character::Picture picture, character::Character* character) {
  const auto taken = [&](const std::string& name) {
    return std::any_of(character->pictures.begin(), character->pictures.end(),
                       [&](const auto& known) { return known.name == name; });
  };
  std::string name = picture.name;
  for (int i = 2; taken(name); ++i) name = picture.name + "_" + std::to_string(i);
  picture.name = name;
  character->rig_pictures.emplace_back(name, static_cast<int>(character->pictures.size()));
  character->pictures.push_back(std::move(picture));
  return name;
}

Status EmbedMaps(const BakedMaps& maps, character::Character* character) {
  for (const BakedMap& baked : maps.maps) {
    auto& known = character->rig.wrinkle_maps;
    const auto map = std::find_if(known.begin(), known.end(),
                                  [&](const auto& entry) { return entry.name == baked.map; });
    if (map == known.end()) {
      return {StatusCode::kNotFound, "the rig has no wrinkle map '" + baked.map + "'"};
    }
    FURROW_RETURN_IF_ERROR(EmbedMap(baked, &*map, character));
  }
  return {};
}

}  // namespace furrow::authoring

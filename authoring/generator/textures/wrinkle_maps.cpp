// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/textures/wrinkle_maps.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "authoring/bake/bake.h"
#include "authoring/bake/bake_pictures.h"
#include "authoring/bake/bake_poses.h"
#include "authoring/generator/textures/skin_relief.h"
#include "authoring/paint/strokes.h"
#include "base/status.h"

namespace furrow::authoring {
namespace {

constexpr int kWrinkleNormalBits = 10;  // a tenth of a degree is enough, since folds are smooth
constexpr float kFineLines = 0.8f;      // for skin that folds twice as deep as at 30 years
constexpr float kNarrow = 4.0f;         // millimetres: strokes with ridges of about 1 mm radius
constexpr float kResting = 0.4f;        // share of the folds that such skin keeps at rest

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

// The normal map of the character's skin, or null.
character::Picture* SkinNormals(character::Character* character) {
  for (const character::Material& material : character->materials) {
    if (material.kind != character::Material::Kind::kSkin || material.normal_texture < 0) continue;
    return &character->pictures[static_cast<std::size_t>(material.normal_texture)];
  }
  return nullptr;
}

}  // namespace

std::vector<BakeStroke> AgedStrokes(std::span<const BakeStroke> strokes, float depth) {
  std::vector<BakeStroke> aged(strokes.begin(), strokes.end());
  for (BakeStroke& stroke : aged) {
    if (!(depth > 1.0f)) continue;
    if (stroke.name.starts_with("lid_")) {
      stroke.depth_mm /= depth;  // and its ridges with it
    } else if (stroke.width_mm < kNarrow) {
      stroke.ridge /= depth;
    }
  }
  return aged;
}

void AddRestingFolds(const BakedMap& map, float share, character::Picture* normals) {
  if (map.width != normals->width || map.height != normals->height) return;
  for (std::size_t i = 0; 3 * i + 2 < normals->pixels16.size(); ++i) {
    std::uint16_t* pixel = &normals->pixels16[3 * i];
    const glm::vec2 slope = share * glm::vec2(map.derivative[2 * i], map.derivative[2 * i + 1]);
    if (slope == glm::vec2(0.0f)) continue;
    const glm::vec3 n(NormalComponent(pixel[0]), NormalComponent(pixel[1]),
                      std::max(NormalComponent(pixel[2]), 0.01f));
    const glm::vec3 folded = glm::normalize(glm::vec3(glm::vec2(n) / n.z + slope, 1.0f));
    for (int c = 0; c < 3; ++c) pixel[c] = NormalTexel(folded[c]);
  }
}

BakeOptions WrinkleMapOptions(int size, float depth) {
  BakeOptions options;
  options.size = size;
  options.skin.depth = depth;
  options.skin.fine_lines = std::clamp(kFineLines * (depth - 1.0f), 0.0f, 1.0f);
  if (depth > 1.0f) options.skin.crossing = 0.0f;
  return options;
}

Status AddWrinkleMaps(std::span<const BakeStroke> strokes, int size, float depth,
                      character::Character* character) {
  Result<CollectedPoses> poses = CollectBakePoses(*character);
  FURROW_RETURN_IF_ERROR(poses);
  Result<BakedMaps> maps = Bake(*character, poses.value().poses, AgedStrokes(strokes, depth),
                                WrinkleMapOptions(size, depth));
  FURROW_RETURN_IF_ERROR(maps);
  const float resting = kResting * std::max(depth - 1.0f, 0.0f);
  character::Picture* normals = SkinNormals(character);
  for (const BakedMap& map : maps.value().maps) {
    if (normals != nullptr && !map.cloth && resting > 0.0f) AddRestingFolds(map, resting, normals);
  }
  if (normals != nullptr && resting > 0.0f) RoundNormals(kSkinNormalBits, normals);
  for (const BakedMap& map : maps.value().maps) {
    FURROW_RETURN_IF_ERROR(AddPictures(map, character));
  }
  return Status();
}

}  // namespace furrow::authoring

// SPDX-License-Identifier: Apache-2.0
#include "character/package/stand_ins.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace furrow::character {
namespace {

constexpr int kSide = 4;
using Texel = std::array<std::uint8_t, 4>;
constexpr Texel kWhite = {255, 255, 255, 255};
constexpr Texel kBlack = {0, 0, 0, 0};
constexpr Texel kFlatNormal = {128, 128, 255, 255};
constexpr Texel kZero = {128, 128, 128, 128};  // of maps with a sign

// The texels to use, one per picture of the character.
std::vector<Texel> NeutralTexels(const Character& character) {
  std::vector<Texel> texels(character.pictures.size(), kWhite);
  const auto set = [&texels](int picture, const Texel& texel) {
    if (picture >= 0) texels.at(static_cast<std::size_t>(picture)) = texel;
  };
  for (const Material& material : character.materials) {
    set(material.normal_texture, kFlatNormal);
    set(material.emission_texture, kBlack);
  }
  const wrinkle::Rig& rig = character.rig;
  for (const wrinkle::Region& region : rig.regions) {
    set(character.FindRigPicture(region.mask.texture), kBlack);
  }
  for (const wrinkle::WrinkleMap& map : rig.wrinkle_maps) {
    set(character.FindRigPicture(map.normal), kFlatNormal);
    set(character.FindRigPicture(map.derivative), kZero);
    set(character.FindRigPicture(map.height), kZero);
  }
  return texels;
}

}  // namespace

void FillStandIns(Character* character) {
  const std::vector<Texel> texels = NeutralTexels(*character);
  for (std::size_t i = 0; i < texels.size(); ++i) {
    Picture& picture = character->pictures[i];
    if (picture.width > 0) continue;
    picture.width = picture.height = kSide;
    picture.channels = 4;
    for (int texel = 0; texel < kSide * kSide; ++texel) {
      picture.pixels.insert(picture.pixels.end(), texels[i].begin(), texels[i].end());
    }
  }
}

}  // namespace furrow::character

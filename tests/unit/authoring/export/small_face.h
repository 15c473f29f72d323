// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "character/character.h"

// A character of one triangle with pictures whose texels are known. It has the materials "skin",
// "shirt" (cloth) and "hair", and a rig of four regions: brow_l and brow_r with the painted masks
// of "masks" (red and green) and the maps stretch and squash; knee with a mask of its own size and
// the cloth map folds, which follows an angle; arm with a mask by skin weights.
namespace furrow::authoring::test {

inline character::Picture MakePicture(const std::string& name, int width, int height, int channels,
                                      const std::function<int(int x, int y, int c)>& texel) {
  character::Picture picture;
  picture.name = name;
  picture.width = width;
  picture.height = height;
  picture.channels = channels;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < channels; ++c) {
        picture.pixels.push_back(static_cast<std::uint8_t>(texel(x, y, c)));
      }
    }
  }
  return picture;
}

inline wrinkle::Feed MakeFeed(const std::string& map, const std::string& driver) {
  wrinkle::Feed feed;
  feed.map = map;
  feed.sources.push_back({driver, "value", 1.0f});
  return feed;
}

inline character::Character SmallFace() {
  using wrinkle::Mask;
  character::Character face;
  face.name = "small";
  for (const auto& [name, kind] : {std::pair("skin", character::Material::Kind::kSkin),
                                   std::pair("shirt", character::Material::Kind::kCloth),
                                   std::pair("hair", character::Material::Kind::kHair)}) {
    face.materials.emplace_back();
    face.materials.back().name = name;
    face.materials.back().kind = kind;
  }
  const auto add = [&](character::Picture picture) {
    face.rig_pictures.emplace_back(picture.name, static_cast<int>(face.pictures.size()));
    face.pictures.push_back(std::move(picture));
  };
  // A slope of 1 in x and of -1 in y, as a normal of (1, -1, 1) / sqrt(3).
  add(MakePicture("squash_normal", 2, 2, 3, [](int, int, int c) { return c == 1 ? 54 : 201; }));
  add(MakePicture("stretch_slopes", 2, 2, 3, [](int, int, int c) { return c == 0 ? 255 : 0; }));
  add(MakePicture("folds_normal", 2, 2, 3, [](int, int, int c) { return c == 2 ? 255 : 128; }));
  add(MakePicture("squash_height", 2, 1, 1, [](int x, int, int) { return x == 0 ? 0 : 255; }));
  add(MakePicture("squash_colour", 1, 1, 3, [](int, int, int c) { return 10 * c; }));
  add(MakePicture("squash_cavity", 1, 1, 1, [](int, int, int) { return 77; }));
  add(MakePicture("masks", 4, 4, 4, [](int x, int y, int c) { return 16 * y + 4 * x + c; }));
  add(MakePicture("knee_mask", 2, 2, 1, [](int x, int y, int) { return 100 * x + 50 * y; }));

  wrinkle::Rig& rig = face.rig;
  rig.name = "small";
  wrinkle::WrinkleMap stretch;
  stretch.name = "stretch";
  stretch.derivative = "stretch_slopes";
  stretch.derivative_scale = 2.0f;
  stretch.surface = wrinkle::WrinkleMap::Surface::kSkin;
  wrinkle::WrinkleMap squash = stretch;
  squash.name = "squash";
  squash.normal = "squash_normal";
  squash.derivative.clear();
  squash.height = "squash_height";
  squash.height_mm = 3.0f;
  squash.colour = "squash_colour";
  squash.colour_scale = 1.25f;
  squash.cavity = "squash_cavity";
  squash.amplitude = 0.5f;
  wrinkle::WrinkleMap folds;
  folds.name = "folds";
  folds.normal = "folds_normal";
  folds.surface = wrinkle::WrinkleMap::Surface::kCloth;
  rig.wrinkle_maps = {stretch, squash, folds};

  for (const char* name : {"brow_l", "brow_r", "knee", "arm"}) {
    wrinkle::Region region;
    region.name = name;
    rig.regions.push_back(region);
  }
  rig.regions[0].mask.texture = rig.regions[1].mask.texture = "masks";
  rig.regions[1].mask.channel = 1;
  rig.regions[2].mask.texture = "knee_mask";
  rig.regions[3].mask.kind = Mask::Kind::kSkinning;
  for (int i : {0, 1}) {
    rig.regions[static_cast<std::size_t>(i)].feeds = {MakeFeed("stretch", "brow"),
                                                      MakeFeed("squash", "brow")};
  }
  rig.regions[2].feeds = {MakeFeed("folds", "knee")};
  rig.regions[2].feeds[0].angles = {{12.0f, 0.0f}, {45.0f, 1.0f}};
  rig.regions[3].feeds = {MakeFeed("folds", "elbow")};
  return face;
}

}  // namespace furrow::authoring::test

// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/bake_package.h"

#include <gtest/gtest.h>

#include "authoring/bake/layers/blood.h"
#include "character/pictures/picture_file.h"

namespace furrow::authoring {
namespace {

// A map of 4 x 1 texels, and masks of five regions of half that width.
character::Character Rigged(BakedMaps* maps) {
  character::Character character;
  character.rig.name = "toy";
  wrinkle::Driver& driver = character.rig.drivers.emplace_back();
  driver.name = "smile";
  driver.kind = wrinkle::Driver::Kind::kBlendShape;
  driver.blend_shape.blend_shape = "smile";
  character.rig.wrinkle_maps = {{.name = "squash", .normal = "old_normal.png", .amplitude = 1.7f},
                                {.name = "other"}};
  BakedMap& map = maps->maps.emplace_back();
  map.map = "squash";
  map.width = 4;
  map.height = 1;
  map.height_mm = {0.0f, -1.23f, 0.4f, 0.01f};
  map.derivative = {0.0f, 0.0f, 1.9f, -0.7f, 0.25f, 0.125f, -3.1f, 0.5f};
  map.cavity = {1.0f, 0.25f, 1.0f, 0.5f};
  map.blood = {1.0f, 1.3f, 0.8f, 1.0f};
  for (int i = 0; i < 5; ++i) {
    const std::string name = "r" + std::to_string(i);
    wrinkle::Region& region = character.rig.regions.emplace_back();
    region.name = name;
    region.mask.texture = "own.png";
    region.feeds = {{"squash", {{"smile", "value", 1.0f}}}};
    map.masks.push_back({name, 2, 1, {0.2f * static_cast<float>(i), 1.0f}});
  }
  return character;
}

character::Picture Decoded(const BakedFiles& files, const std::string& name) {
  for (const BakedFiles::File& file : files.files) {
    if (file.name != name) continue;
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(file.bytes.data());
    return *character::DecodePicture(name, {bytes, file.bytes.size()});
  }
  ADD_FAILURE() << name;
  return {};
}

TEST(BakePackage, SixteenBitsAndAScaleRestoreTheValues) {
  BakedMaps maps;
  const character::Character character = Rigged(&maps);
  const auto files = PackageMaps(character, maps, {});
  ASSERT_TRUE(files.ok()) << files.status().ToString();
  const wrinkle::WrinkleMap& map = files->rig.wrinkle_maps[0];
  EXPECT_EQ(map.normal, "");
  EXPECT_EQ(map.amplitude, 1.0f);
  EXPECT_EQ(map.cavity, "squash_cavity.png");
  EXPECT_EQ(files->rig.wrinkle_maps[1].derivative, "");  // not baked
  const character::Picture derivative = Decoded(*files, map.derivative);
  const character::Picture height = Decoded(*files, map.height);
  const auto value = [](std::uint16_t texel, float scale) {
    return (2.0f * static_cast<float>(texel) / 65535.0f - 1.0f) * scale;
  };
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_NEAR(value(derivative.pixels16[3 * i + k], map.derivative_scale),
                  maps.maps[0].derivative[2 * i + k], map.derivative_scale / 65535.0f);
    }
    EXPECT_NEAR(value(height.pixels16[i], map.height_mm), maps.maps[0].height_mm[i],
                map.height_mm / 65535.0f);
  }
  EXPECT_EQ(Decoded(*files, map.cavity).pixels[1], 64);
  EXPECT_EQ(map.colour, "squash_colour.png");
  EXPECT_EQ(map.colour_scale, kBloodTintScale);
  const character::Picture colour = Decoded(*files, map.colour);
  EXPECT_EQ(colour.pixels[0], 230);  // the colour at rest
  EXPECT_LT(colour.pixels[3 + 1], 225);
  EXPECT_GT(colour.pixels[6 + 1], 232);
}

TEST(BakePackage, ClothHasNoBloodAndKeepsItsColour) {
  BakedMaps maps;
  character::Character character = Rigged(&maps);
  character.rig.wrinkle_maps[0].colour = "worn.png";
  maps.maps[0].cloth = true;
  const auto files = PackageMaps(character, maps, {});
  ASSERT_TRUE(files.ok()) << files.status().ToString();
  EXPECT_EQ(files->rig.wrinkle_maps[0].colour, "worn.png");
  EXPECT_EQ(files->rig.wrinkle_maps[0].colour_scale, 1.0f);
}

TEST(BakePackage, ExrContainsTheValuesThemselves) {
  BakedMaps maps;
  const character::Character character = Rigged(&maps);
  const auto files = PackageMaps(character, maps, {.exr = true});
  ASSERT_TRUE(files.ok());
  const character::Picture derivative = Decoded(*files, "squash_derivative.exr");
  ASSERT_EQ(derivative.pixels_float.size(), 8u);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_NEAR(derivative.pixels_float[i], maps.maps[0].derivative[i], 2e-3f);
  }
  EXPECT_NEAR(Decoded(*files, "squash_height.exr").pixels_float[1], -1.23f, 1e-3f);
}

TEST(BakePackage, PacksFourRegionsPerPicture) {
  BakedMaps maps;
  const character::Character character = Rigged(&maps);
  const auto files = PackageMaps(character, maps, {.masks = true});
  ASSERT_TRUE(files.ok());
  const character::Picture first = Decoded(*files, "masks_skin_0.png");
  EXPECT_EQ(first.width, 2);
  EXPECT_EQ(first.pixels[2], 102);  // blue, the third region: 0.4
  EXPECT_EQ(Decoded(*files, "masks_skin_1.png").pixels[0], 204);
  EXPECT_EQ(files->rig.regions[4].mask.texture, "masks_skin_1.png");
  EXPECT_EQ(files->rig.regions[4].mask.channel, 0);
  EXPECT_EQ(files->rig.regions[3].mask.channel, 3);
  const auto own = PackageMaps(character, maps, {});
  EXPECT_EQ(own->rig.regions[4].mask.texture, "own.png");
  EXPECT_EQ(Decoded(*own, "suggested_masks_skin_1.png").pixels[0], 204);
}

TEST(BakePackage, DoesNotOverwriteMasksInUse) {
  BakedMaps maps;
  character::Character character = Rigged(&maps);
  // This bake leaves out region 4, which uses the blue channel of a picture from an earlier bake.
  maps.maps[0].masks.pop_back();
  wrinkle::Mask& mask = character.rig.regions[4].mask;
  mask = {.kind = wrinkle::Mask::Kind::kTexture, .texture = "masks_skin_0.png", .channel = 2};
  const auto files = PackageMaps(character, maps, {.masks = true});
  ASSERT_TRUE(files.ok()) << files.status().ToString();
  EXPECT_EQ(files->rig.regions[0].mask.texture, "masks_skin_0_2.png");
  EXPECT_EQ(files->rig.regions[4].mask.texture, "masks_skin_0.png");
  EXPECT_EQ(files->rig.regions[4].mask.channel, 2);
  for (const BakedFiles::File& file : files->files) EXPECT_NE(file.name, "masks_skin_0.png");
}

TEST(BakePackage, RegionOfTwoAtlasesKeepsItsMask) {
  BakedMaps maps;
  character::Character character = Rigged(&maps);
  character.rig.regions[1].mask.texture = "mine.png";
  BakedMap cloth = maps.maps[0];
  cloth.map = "other";
  cloth.cloth = true;
  cloth.masks = {cloth.masks[1]};
  maps.maps.push_back(cloth);
  const auto files = PackageMaps(character, maps, {.masks = true});
  ASSERT_TRUE(files.ok()) << files.status().ToString();
  EXPECT_EQ(files->rig.regions[1].mask.texture, "mine.png");
  EXPECT_EQ(files->rig.regions[2].mask.texture, "masks_skin_0.png");
  EXPECT_EQ(files->rig.regions[2].mask.channel, 1);
  ASSERT_EQ(files->notes.size(), 1u);
  EXPECT_NE(files->notes[0].find("region 'r1'"), std::string::npos);
}

TEST(BakePackage, RejectsValuesThatARigCannotContain) {
  BakedMaps maps;
  const character::Character character = Rigged(&maps);
  maps.maps[0].derivative[0] = 700.0f;
  const Status steep = PackageMaps(character, maps, {}).status();
  EXPECT_EQ(steep.code(), StatusCode::kInvalidArgument);
  EXPECT_NE(steep.what().find("map 'squash' is too steep"), std::string::npos);
  EXPECT_TRUE(PackageMaps(character, maps, {.exr = true}).ok());
}

TEST(BakePackage, ScalesAreRoundAndLargeEnough) {
  EXPECT_FLOAT_EQ(RoundScale({}, 0.25f), 0.25f);
  EXPECT_FLOAT_EQ(RoundScale({0.1f, -0.31f}, 0.25f), 0.35f);
  EXPECT_FLOAT_EQ(RoundScale({3.2f}, 0.25f), 3.5f);
  for (float x = 0.011f; x < 90.0f; x *= 1.07f) {
    const float scale = RoundScale({-x}, 0.01f);
    EXPECT_GE(scale, x * 0.9999f);
    EXPECT_LE(scale, 1.6f * x);
  }
}

}  // namespace
}  // namespace furrow::authoring

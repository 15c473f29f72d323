// SPDX-License-Identifier: Apache-2.0
#include "character/gltf/gltf_material_binds.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "character/gltf/gltf_writer.h"
#include "character/package/package.h"

namespace furrow::character {
namespace {

using ::testing::ElementsAre;
using ::testing::SizeIs;

gltf::MaterialBind Glow(const char* shape, int material) {
  return {.shape = shape, .material = material, .emission = glm::vec3(1.0f)};
}

TEST(GltfMaterialBinds, ActWithMorphTargetsOfTheirNameAndAddOtherShapes) {
  std::vector<std::string> shapes = {"Joy", "a"};
  std::vector<MaterialBind> binds;
  const std::vector<gltf::MaterialBind> from = {Glow("joy", 0), Glow("blush", 1), Glow("blush", 0),
                                                Glow("BLUSH", 0)};
  EXPECT_TRUE(MakeMaterialBinds(from, &shapes, &binds).empty());
  EXPECT_THAT(shapes, ElementsAre("Joy", "a", "blush"));
  ASSERT_THAT(binds, SizeIs(3));
  EXPECT_EQ(binds[0].shape, 0u);
  EXPECT_EQ(binds[1].shape, 2u);
  EXPECT_EQ(binds[1].material, 1u);
  EXPECT_EQ(binds[2].shape, 2u);
  EXPECT_EQ(binds[2].emission, glm::vec3(1.0f));
}

TEST(GltfMaterialBinds, ShapesBeyondTheLimitAreLeftOut) {
  std::vector<std::string> shapes;
  for (std::size_t i = 1; i < kMaxShapes; ++i) shapes.push_back(std::to_string(i));
  std::vector<MaterialBind> binds;
  const std::vector<gltf::MaterialBind> from = {Glow("x", 0), Glow("y", 0), Glow("y", 1),
                                                Glow("7", 0)};
  EXPECT_THAT(MakeMaterialBinds(from, &shapes, &binds), ElementsAre("y"));
  EXPECT_THAT(shapes, SizeIs(kMaxShapes));
  ASSERT_THAT(binds, SizeIs(2));
  EXPECT_EQ(binds[1].shape, 6u);
}

class ToyPackage : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto toy =
        ReadFile(FURROW_SOURCE_DIR "/tests/unit/character/gltf/fixtures/toy.glb", 1 << 20);
    ASSERT_TRUE(toy.ok());
    auto character = ParseCharacter(*toy, {});
    ASSERT_TRUE(character.ok()) << character.status().ToString();
    toy_ = std::move(*character);
  }
  Character Again() {
    const auto glb = CharacterGlb(toy_);
    EXPECT_TRUE(glb.ok()) << glb.status().ToString();
    auto again = ParseCharacter(*glb, {});
    EXPECT_TRUE(again.ok()) << again.status().ToString();
    return again.ok() ? std::move(*again) : Character();
  }
  Character toy_;
};

TEST_F(ToyPackage, KeepsItsBinds) {
  ASSERT_TRUE(toy_.material_binds.empty());
  const std::size_t before = toy_.shapes.size();
  toy_.shapes.emplace_back("blush");
  toy_.material_binds = {{.shape = 0, .material = 0, .uv_scale = {-0.5f, 1.0f}},
                         {.shape = static_cast<std::uint32_t>(before),
                          .material = 0,
                          .base_colour = {0.25f, -0.5f, -0.125f, 0.5f},
                          .emission = {0.0f, 3.0f, 0.5f},
                          .uv_offset = {0.0f, 0.25f}}};
  const Character again = Again();
  EXPECT_EQ(again.shapes, toy_.shapes) << "a shape that only changes a material stays";
  ASSERT_THAT(again.material_binds, SizeIs(2));
  EXPECT_EQ(again.material_binds[0].uv_scale, glm::vec2(-0.5f, 1.0f));
  EXPECT_EQ(again.material_binds[1].shape, before);
  EXPECT_EQ(again.material_binds[1].base_colour, toy_.material_binds[1].base_colour);
  EXPECT_EQ(again.material_binds[1].emission, toy_.material_binds[1].emission);
  EXPECT_EQ(again.material_binds[1].uv_offset, toy_.material_binds[1].uv_offset);
}

TEST_F(ToyPackage, KeepsItsEmission) {
  ASSERT_FALSE(toy_.materials.empty());
  ASSERT_FALSE(toy_.pictures.empty());
  EXPECT_EQ(toy_.materials[0].emission, glm::vec3(0.0f));
  toy_.materials[0].emission = {0.5f, 4.0f, 0.0f};
  toy_.materials[0].emission_texture = 0;
  const Character again = Again();
  EXPECT_EQ(again.materials[0].emission, glm::vec3(0.5f, 4.0f, 0.0f));
  EXPECT_EQ(again.materials[0].emission_texture, 0);
}

}  // namespace
}  // namespace furrow::character

// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/model/atlases.h"

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "authoring/bake/surface/bake_surface.h"
#include "authoring/bake/surface/uv_check.h"

namespace furrow::authoring {
namespace {

using character::Character;
using character::Material;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

// A square of one material, `metres` wide, whose UVs run from `low` to `high`.
void AddSquare(const std::string& name, Material::Kind kind, float metres, const glm::vec2& low,
               const glm::vec2& high, Character* character) {
  character::Mesh& mesh = character->meshes.emplace_back();
  mesh.name = name;
  mesh.material = static_cast<int>(character->materials.size());
  character->materials.push_back({.name = name, .kind = kind});
  for (const glm::vec2 corner : {glm::vec2(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
    character::Vertex& vertex = mesh.vertices.emplace_back();
    vertex.position = {metres * corner, 0.0f};
    vertex.uv = low + corner * (high - low);
  }
  mesh.indices = {0, 1, 2, 0, 2, 3};
}

// A shirt, trousers and a tiled belt over the same texels, shoes beside skin.
Character Dressed() {
  Character character;
  AddSquare("shirt", Material::Kind::kCloth, 1.0f, {0.1f, 0.1f}, {0.9f, 0.9f}, &character);
  AddSquare("trousers", Material::Kind::kCloth, 2.0f, {0, 0}, {1, 1}, &character);
  AddSquare("belt", Material::Kind::kCloth, 0.1f, {-2, 0}, {3, 0.5f}, &character);
  AddSquare("face", Material::Kind::kSkin, 0.2f, {0, 0}, {1, 1}, &character);
  return character;
}

TEST(TileClothAtlas, PartsTheClothesAndLeavesTheirTexturesInPlace) {
  const Character before = Dressed();
  Character after = before;
  EXPECT_THAT(TileClothAtlas(&after), ElementsAre("trousers", "shirt", "belt"));
  const std::vector<int> cloth = MeshesOn(after, true);
  ASSERT_EQ(cloth.size(), 3u);
  const UvReport uvs = CheckUvs(after, cloth);
  EXPECT_EQ(uvs.overlapping, 0.0f);
  EXPECT_EQ(uvs.outside_triangles, 0);
  for (std::size_t m = 0; m < after.meshes.size(); ++m) {
    const character::Mesh& mesh = after.meshes[m];
    const Material& material = after.materials[static_cast<std::size_t>(mesh.material)];
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
      const glm::vec2 uv = mesh.vertices[v].uv * material.texture_scale + material.texture_offset;
      EXPECT_LT(glm::distance(uv, before.meshes[m].vertices[v].uv), 1e-5f) << mesh.name;
    }
  }
  EXPECT_EQ(after.meshes[3].vertices[2].uv, glm::vec2(1.0f));  // the face stays
  // Nothing is left to be chosen, and a second call finds nothing to do.
  EXPECT_THAT(ChooseAtlases(-1, &after), IsEmpty());
  EXPECT_THAT(TileClothAtlas(&after), IsEmpty());
}

TEST(TileClothAtlas, LeavesClothesAloneThatShareAnAtlas) {
  Character character;
  AddSquare("left", Material::Kind::kCloth, 1.0f, {0, 0}, {0.5f, 1}, &character);
  AddSquare("right", Material::Kind::kCloth, 1.0f, {0.5f, 0}, {1, 1}, &character);
  EXPECT_THAT(TileClothAtlas(&character), IsEmpty());
  EXPECT_EQ(character.meshes[0].vertices[2].uv, glm::vec2(0.5f, 1.0f));
  EXPECT_EQ(character.materials[0].texture_scale, glm::vec2(1.0f));
}

TEST(ChooseAtlases, KeepsTheLargestOfThoseThatOverlap) {
  Character character = Dressed();
  EXPECT_THAT(ChooseAtlases(-1, &character), ElementsAre("shirt", "belt"));
  EXPECT_TRUE(character.materials[1].wrinkles);
  EXPECT_FALSE(character.materials[0].wrinkles);
  EXPECT_TRUE(character.materials[3].wrinkles);
}

}  // namespace
}  // namespace furrow::authoring

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
using ::testing::Field;
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

// A face, a body and hands that each fill the unit square, lips in an empty corner of the face's,
// nails in the next square of a UDIM grid.
Character Bare() {
  Character character;
  AddSquare("body", Material::Kind::kSkin, 2.0f, {0, 0}, {1, 1}, &character);
  AddSquare("face", Material::Kind::kSkin, 0.2f, {0, 0}, {1, 0.9f}, &character);
  AddSquare("lips", Material::Kind::kSkin, 0.05f, {0, 0.91f}, {0.5f, 1}, &character);
  AddSquare("hands", Material::Kind::kSkin, 0.3f, {0.005f, 0}, {1, 1}, &character);
  AddSquare("nails", Material::Kind::kSkin, 0.01f, {1, 0.2f}, {2, 0.9f}, &character);
  AddSquare("shirt", Material::Kind::kCloth, 1.0f, {0, 0}, {1, 1}, &character);
  return character;
}

// The UVs in the atlas do not overlap, and lead back to the places of `before` in the textures.
void ExpectTiled(const Character& before, const Character& after, bool cloth) {
  const UvReport uvs = CheckUvs(after, MeshesOn(after, cloth));
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
}

// The texels of an atlas that a material's UVs cover.
float Covered(const Character& character, int mesh) {
  return CheckUvs(character, std::span(&mesh, 1)).covered;
}

TEST(TileAtlas, PartsTheClothesAndLeavesTheirTexturesInPlace) {
  const Character before = Dressed();
  Character after = before;
  EXPECT_THAT(TileAtlas(true, -1, &after),
              ElementsAre(Field(&AtlasTile::materials, ElementsAre("trousers")),
                          Field(&AtlasTile::materials, ElementsAre("shirt")),
                          Field(&AtlasTile::materials, ElementsAre("belt"))));
  ASSERT_EQ(MeshesOn(after, true).size(), 3u);
  ExpectTiled(before, after, true);
  EXPECT_EQ(after.meshes[3].vertices[2].uv, glm::vec2(1.0f));  // the face stays
  // Nothing is left to be chosen, and a second call finds nothing to do.
  EXPECT_THAT(ChooseAtlases(-1, &after), IsEmpty());
  EXPECT_THAT(TileAtlas(true, -1, &after), IsEmpty());
}

// The face (material 1) gets the left 60%, with its lips; the others share the rest.
TEST(TileAtlas, TheFaceKeepsTheLargerPartOfTheSkin) {
  const Character before = Bare();
  Character after = before;
  const std::vector<AtlasTile> tiles = TileAtlas(false, 1, &after);
  EXPECT_THAT(tiles, ElementsAre(Field(&AtlasTile::materials, ElementsAre("face", "lips")),
                                 Field(&AtlasTile::materials, ElementsAre("body")),
                                 Field(&AtlasTile::materials, ElementsAre("hands")),
                                 Field(&AtlasTile::materials, ElementsAre("nails"))));
  EXPECT_FLOAT_EQ(tiles[0].share, 0.6f);
  EXPECT_NEAR(tiles[1].share, 0.4f / 3.0f, 1e-6f);
  EXPECT_THAT(DescribeTiles(tiles, false),
              ::testing::HasSubstr("'face' and 'lips' 60 %, 'body' 13 %, 'hands' 13 %"));
  EXPECT_EQ(MeshesOn(after, false).size(), 5u);
  ExpectTiled(before, after, false);
  EXPECT_GT(Covered(after, 1), 0.6f * 0.9f * 0.95f);  // a margin of 1% on each side
  EXPECT_GT(Covered(after, 0), 0.13f * 0.95f);
  EXPECT_GT(Covered(after, 4), 0.13f * 0.7f * 0.95f);  // the square of the grid fills its tile
  EXPECT_EQ(after.meshes[5].vertices[2].uv, glm::vec2(1.0f));  // the shirt stays
  EXPECT_THAT(ChooseAtlases(1, &after), IsEmpty());
  EXPECT_THAT(TileAtlas(false, 1, &after), IsEmpty());
}

TEST(TileAtlas, MirroredHalvesOfOneMaterialStayMirrored) {
  Character character;
  AddSquare("face", Material::Kind::kSkin, 0.2f, {0, 0}, {1, 1}, &character);
  AddSquare("half", Material::Kind::kSkin, 0.2f, {0, 0}, {1, 1}, &character);
  character.meshes[1].material = 0;
  Character alone = character;
  EXPECT_THAT(TileAtlas(false, 0, &alone), IsEmpty());
  AddSquare("body", Material::Kind::kSkin, 2.0f, {0, 0}, {1, 1}, &character);
  EXPECT_EQ(TileAtlas(false, 0, &character).size(), 2u);
  for (std::size_t v = 0; v < 4; ++v) {
    EXPECT_EQ(character.meshes[0].vertices[v].uv, character.meshes[1].vertices[v].uv);
  }
}

TEST(TileAtlas, ManyMaterialsGetColumnsBesideTheFace) {
  Character before;
  for (int i = 0; i < 12; ++i) {
    AddSquare("skin" + std::to_string(i), Material::Kind::kSkin, 1.0f, {0, 0}, {1, 1}, &before);
  }
  Character after = before;
  const std::vector<AtlasTile> tiles = TileAtlas(false, 3, &after);
  ASSERT_EQ(tiles.size(), 12u);
  EXPECT_THAT(tiles[0].materials, ElementsAre("skin3"));
  ExpectTiled(before, after, false);
}

TEST(TileAtlas, LeavesClothesAloneThatShareAnAtlas) {
  Character character;
  AddSquare("left", Material::Kind::kCloth, 1.0f, {0, 0}, {0.5f, 1}, &character);
  AddSquare("right", Material::Kind::kCloth, 1.0f, {0.5f, 0}, {1, 1}, &character);
  EXPECT_THAT(TileAtlas(true, -1, &character), IsEmpty());
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

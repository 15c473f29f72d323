// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/textures/skin_colour.h"

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "authoring/generator/head/head_skin.h"
#include "authoring/generator/textures/head_brows.h"
#include "authoring/generator/textures/skin_regions.h"
#include "authoring/generator/textures/skin_relief.h"
#include "authoring/paint/canvas.h"
#include "character/package/package.h"

namespace furrow::authoring {
namespace {

// Mean of the green channel over the texels for which `where` is true, in [0, 1].
template <typename Where>
float MeanGreen(const character::Mesh& skin, character::Picture* picture, const Where& where) {
  double sum = 0.0;
  int count = 0;
  for (const SurfaceTexel& texel : RasterizeSurface(skin, picture->width, picture->height)) {
    if (!where(ModelToHead(texel.position))) continue;
    sum += TexelAt(picture, texel.x, texel.y)[1];
    ++count;
  }
  EXPECT_GT(count, 5);
  return count == 0 ? -1.0f : static_cast<float>(sum / (255.0 * count));
}

bool OnEar(const glm::vec3& p) { return std::abs(p.x) > 8.6f && std::abs(p.y) < 3.0f; }
bool OnForehead(const glm::vec3& p) { return std::abs(p.x) < 2.0f && p.y > 3.5f && p.y < 5.0f; }

TEST(SkinPaint, EarsAreThinnerThanTheSkull) {
  const character::Mesh skin = MakeHeadSkin().mesh;
  character::Picture thickness = PaintSkinThickness(skin, DefaultHead(), 256);
  EXPECT_LT(MeanGreen(skin, &thickness, OnEar), 0.3f);  // fraction of kFullThickness
  EXPECT_GT(MeanGreen(skin, &thickness, OnForehead), 0.9f);
}

TEST(SkinPaint, LipsAreSmootherThanCheeks) {
  const character::Mesh skin = MakeHeadSkin().mesh;
  character::Picture roughness = PaintSkinRoughness(skin, 256);
  const auto on_lip = [](const glm::vec3& p) {
    return std::abs(p.x) < 1.0f && p.y < kMouthY - 0.3f && p.y > kMouthY - 0.6f && p.z > 8.5f;
  };
  const auto on_cheek = [](const glm::vec3& p) {
    return p.x > 4.5f && p.x < 6.0f && p.y < -4.0f && p.y > -6.0f && p.z > 3.0f;
  };
  EXPECT_LT(MeanGreen(skin, &roughness, on_lip) + 0.08f, MeanGreen(skin, &roughness, on_cheek));
}

TEST(SkinPaint, BrowsAndLipsAreInPlace) {
  EXPECT_GT(LipShare({0.5f, kMouthY - 0.4f, 9.5f}), 0.9f);
  EXPECT_EQ(LipShare({0.5f, kMouthY - 2.0f, 9.0f}), 0.0f);
  EXPECT_EQ(LipShare({4.0f, kMouthY, 7.0f}), 0.0f);
  float brow = 0.0f;
  for (float x = 1.5f; x < 4.5f; x += 0.05f) brow += BrowShare({x, 2.0f, 8.0f}, {}) / 60.0f;
  EXPECT_GT(brow, 0.35f);
  EXPECT_EQ(BrowShare({0.0f, 2.0f, 9.0f}, {}), 0.0f);
  EXPECT_EQ(BrowShare({3.0f, 4.0f, 8.0f}, {}), 0.0f);
}

// A file keeps the thickness of a material (KHR_materials_volume).
TEST(SkinPaint, ThicknessReadsBackEqual) {
  character::Character character;
  character.name = "slab";
  Result<wrinkle::Skeleton> skeleton = wrinkle::Skeleton::Create({{.name = "root"}});
  ASSERT_TRUE(skeleton.ok());
  character.skeleton = std::move(skeleton).value();
  character.inverse_bind_matrices.emplace_back(1.0f);
  character.pictures.push_back(BlankPicture("thickness", 4, 4, 3));
  character::Material material;
  material.name = "skin";
  material.thickness = kFullThickness;
  material.thickness_texture = 0;
  character.materials.push_back(material);
  character::Mesh mesh;
  mesh.name = "slab";
  mesh.material = 0;
  mesh.vertices.resize(3);
  mesh.vertices[1].position = {1, 0, 0};
  mesh.vertices[2].position = {0, 1, 0};
  mesh.vertices[1].uv = {1, 0};
  mesh.vertices[2].uv = {0, 1};
  mesh.indices = {0, 1, 2};
  character.meshes.push_back(mesh);
  const std::filesystem::path glb = std::filesystem::path(testing::TempDir()) / "furrow_slab.glb";
  ASSERT_TRUE(character::SaveCharacterGlb(character, glb).ok());
  const Result<character::Character> read = character::LoadCharacter(glb);
  std::filesystem::remove(glb);
  ASSERT_TRUE(read.ok()) << read.status().ToString();
  ASSERT_EQ(read.value().materials.size(), 1u);
  EXPECT_FLOAT_EQ(read.value().materials[0].thickness, kFullThickness);
  EXPECT_EQ(read.value().materials[0].thickness_texture, 0);
}

}  // namespace
}  // namespace furrow::authoring

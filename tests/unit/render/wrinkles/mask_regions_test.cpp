// SPDX-License-Identifier: Apache-2.0
#include "render/wrinkles/mask_regions.h"

#include <cmath>

#include <gtest/gtest.h>

#include "render/mesh/uv_density.h"
#include "tests/unit/render/test_character.h"

namespace furrow::render {
namespace {

// Masks: red is above 0 on the subject's left half and green on its right half, both between one
// quarter and three quarters of the height.
class MaskRegionsTest : public testing::Test {
 protected:
  void Find(const character::Picture& mask) {
    regions_.clear();
    AddMaskRegions(head_, mask, 2, &regions_);
  }
  // The horizontal range, [-1, 1], that a region's bounds cover in a picture of the face.
  glm::vec2 Across(const MaskRegion& region) const {
    glm::mat4 projection(0.0f);  // as wide as the head
    projection[0][0] = 10.0f;
    projection[1][1] = 1.0f;
    projection[3] = {0.0f, -1.6f, 0.0f, 1.0f};
    const auto extent = region.bounds.Look({subject_.model, {}}, projection);
    return {extent.low.x, extent.high.x};
  }

  character::Character head_ = test::MakeHead();
  test::Subject subject_{head_};
  std::vector<MaskRegion> regions_;
};

TEST_F(MaskRegionsTest, AreWhereAChannelIsAboveZero) {
  const int masks = head_.FindRigPicture("masks.png");
  Find(head_.pictures[static_cast<std::size_t>(masks)]);
  ASSERT_EQ(regions_.size(), 2u);  // blue and alpha are empty
  EXPECT_EQ(regions_[0].channel, 8);
  EXPECT_EQ(regions_[1].channel, 9);
  EXPECT_EQ(regions_[0].material, 0);
  EXPECT_GT(Across(regions_[0]).x, -0.2f);  // the subject's left is on the right
  EXPECT_GT(Across(regions_[0]).y, 0.7f);
  EXPECT_LT(Across(regions_[1]).x, -0.7f);
  EXPECT_LT(Across(regions_[1]).y, 0.2f);
}

// A speck that contains no vertex.
TEST_F(MaskRegionsTest, ASpeckWithinATriangleIsFound) {
  const auto flat = [](float, float) { return 0.0f; };
  head_ = test::MakePlane(16, flat, {flat});
  Find(test::MakePicture("speck", 64, [](float u, float v) {
    const bool here = std::abs(u - 0.3f) < 0.01f && std::abs(v - 0.6f) < 0.01f;
    return glm::vec4(here ? 1.0f : 0.0f, 0.0f, 0.0f, 0.0f);
  }));
  ASSERT_EQ(regions_.size(), 1u);
  EXPECT_NEAR(regions_[0].uv_per_metre, 0.5f, 1e-4f);  // 2 m wide
}

TEST_F(MaskRegionsTest, EyesAndHairHaveNone) {
  const auto everywhere = test::MakePicture("all", 4, [](float, float) { return glm::vec4(1.0f); });
  Find(everywhere);
  EXPECT_EQ(regions_.size(), 4u);
  character::Material skin = head_.materials[0];
  head_.materials[0].kind = character::Material::Kind::kEye;
  head_.materials.push_back(skin);  // no mesh uses it
  Find(everywhere);
  EXPECT_TRUE(regions_.empty());
}

TEST(UvDensity, IsTheDensityOfTheMostStretchedSurface) {
  character::Mesh mesh;
  // A strip of squares of 1 m. One in ten has a fifth of the others' UV along u.
  float u = 0.0f;
  for (int i = 0; i < 20; ++i) {
    const float step = i % 10 == 0 ? 0.1f : 0.5f;
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const auto& [x, y] : {std::pair(0.0f, 0.0f), {1.0f, 0.0f}, {1.0f, 1.0f}, {0.0f, 1.0f}}) {
      character::Vertex vertex;
      vertex.position = {static_cast<float>(i) + x, y, 0.0f};
      vertex.uv = {u + step * x, 0.05f * y};
      mesh.vertices.push_back(vertex);
    }
    u += step;
    for (const std::uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u})
      mesh.indices.push_back(first + corner);
  }
  EXPECT_NEAR(MinUvPerMetre(mesh), 0.1f, 1e-5f);
  EXPECT_EQ(MinUvPerMetre(character::Mesh()), 0.0f);
}

}  // namespace
}  // namespace furrow::render

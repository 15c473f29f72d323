// SPDX-License-Identifier: Apache-2.0
#include "render/compose/skinned_masks.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/unit/render/character_parts.h"
#include "wrinkle/weights/vertex_influence.h"

namespace furrow::render {
namespace {

constexpr int kJoints = 4;
constexpr int kMaskSide = 64;  // per side

SkinnedShare ShareOf(int joint, int column, wrinkle::LambdaMode lambda) {
  return {joint, column, {column, lambda, 0.25f}};
}

// A sheet in a part of the texture, skinned by `skin`.
character::Mesh Sheet(glm::vec2 low, glm::vec2 high,
                      const std::function<void(float u, float v, character::Vertex*)>& skin) {
  character::Mesh mesh;
  test::AddGrid(
      6, 5,
      [&](float u, float v) {
        character::Vertex vertex;
        vertex.position = {u, v, 0.0f};
        vertex.uv = low + (high - low) * glm::vec2(u, v);
        skin(u, v, &vertex);
        return vertex;
      },
      &mesh);
  return mesh;
}

// Skin weights that change from one joint on the left to another on the right.
std::function<void(float, float, character::Vertex*)> Across(std::uint16_t left,
                                                             std::uint16_t right) {
  return [=](float u, float, character::Vertex* vertex) {
    vertex->joints[0] = left;
    vertex->joints[1] = right;
    vertex->skin_weights[0] = 1.0f - u;
    vertex->skin_weights[1] = u;
  };
}

SkinnedMasks MasksOf(const std::vector<character::Mesh>& meshes,
                     const std::vector<SkinnedShare>& shares) {
  const std::vector<glm::mat4> inverse_bind(kJoints, glm::mat4(1.0f));
  return {meshes, shares, inverse_bind, 0};
}

std::vector<ComposeTile> EmptyTiles() {
  constexpr int kTiles = kMaskSide / ComposeTile::kSide;
  std::vector<ComposeTile> tiles(kTiles * kTiles);
  for (int i = 0; i < kTiles * kTiles; ++i) {
    tiles[static_cast<std::size_t>(i)].place = {i % kTiles, i / kTiles};
  }
  return tiles;
}

// A mask channel at a texel, [0, 1].
float At(const std::vector<ComposeTile>& tiles, glm::ivec2 texel, std::size_t channel) {
  constexpr int kSide = ComposeTile::kSide;
  for (const ComposeTile& tile : tiles) {
    if (tile.place != texel / kSide) continue;
    for (const ComposeTile::Mask& mask : tile.skinned) {
      const glm::ivec2 within = texel % kSide;
      if (mask.channel == channel) {
        return static_cast<float>(
                   mask.values.at(static_cast<std::size_t>(within.y * kSide + within.x))) /
               255.0f;
      }
    }
  }
  return 0.0f;
}

// The mask of a mesh at a point of the texture, interpolated from its vertices.
float MaskAt(const character::Mesh& mesh, glm::vec2 uv, const SkinnedShare& share) {
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const character::Vertex* corners[3];
    for (std::size_t k = 0; k < 3; ++k) corners[k] = &mesh.vertices[mesh.indices[i + k]];
    const auto cross = [](glm::vec2 a, glm::vec2 b) { return a.x * b.y - a.y * b.x; };
    const glm::vec2 a = corners[1]->uv - corners[0]->uv;
    const glm::vec2 b = corners[2]->uv - corners[0]->uv;
    const float second = cross(uv - corners[0]->uv, b) / cross(a, b);
    const float third = cross(a, uv - corners[0]->uv) / cross(a, b);
    if (second < 0.0f || third < 0.0f || second + third > 1.0f) continue;
    const float shares[3] = {1.0f - second - third, second, third};
    std::vector<float> influences(kJoints, 0.0f);
    influences[static_cast<std::size_t>(share.joint)] = 1.0f;
    float sum = 0.0f;
    for (int k = 0; k < 3; ++k) {
      sum += shares[k] * wrinkle::VertexInfluence(corners[k]->joints, corners[k]->skin_weights,
                                                  influences, 1, 0, share.mask.lambda,
                                                  share.mask.smooth_width);
    }
    return sum;
  }
  return 0.0f;
}

class SkinnedMasksTest : public testing::TestWithParam<wrinkle::LambdaMode> {};

TEST_P(SkinnedMasksTest, TexelsMatchInterpolatedVertices) {
  const character::Mesh sheet = Sheet({0.1f, 0.2f}, {0.8f, 0.9f}, Across(1, 2));
  const std::vector<SkinnedShare> shares = {ShareOf(1, 0, GetParam()), ShareOf(3, 0, GetParam()),
                                            ShareOf(2, 0, GetParam())};
  const SkinnedMasks masks = MasksOf({sheet}, shares);
  ASSERT_TRUE(masks.is_unique());
  ASSERT_EQ(masks.channels().size(), 2u);  // no vertex is skinned to joint 3
  std::vector<ComposeTile> tiles = EmptyTiles();
  masks.AddTo({kMaskSide, kMaskSide}, 5, &tiles);
  int within = 0;
  for (std::size_t channel = 0; channel < 2; ++channel) {
    for (int y = 0; y < kMaskSide; ++y) {
      for (int x = 0; x < kMaskSide; ++x) {
        const glm::vec2 uv = (glm::vec2(x, y) + 0.5f) / static_cast<float>(kMaskSide);
        if (uv.x < 0.1f || uv.x > 0.8f || uv.y < 0.2f || uv.y > 0.9f) continue;
        EXPECT_NEAR(At(tiles, {x, y}, 5 + channel), MaskAt(sheet, uv, masks.channels()[channel]),
                    0.6f / 255.0f)
            << x << " " << y;
        ++within;
      }
    }
  }
  EXPECT_GT(within, 3000);
}

INSTANTIATE_TEST_SUITE_P(Lambdas, SkinnedMasksTest,
                         testing::Values(wrinkle::LambdaMode::kSmooth, wrinkle::LambdaMode::kBinary,
                                         wrinkle::LambdaMode::kLinear));

// Masks extend beyond the edge of the surface as far as filtering needs, and not much further.
TEST(SkinnedMasks, ExtendBeyondTheSurface) {
  const auto all = [](float, float, character::Vertex* vertex) { vertex->joints[0] = 1; };
  const SkinnedMasks masks = MasksOf({Sheet({0.25f, 0.25f}, {0.5f, 0.5f}, all)},
                                     {ShareOf(1, 0, wrinkle::LambdaMode::kLinear)});
  std::vector<ComposeTile> tiles = EmptyTiles();
  masks.AddTo({kMaskSide, kMaskSide}, 0, &tiles);
  for (int y = 0; y < kMaskSide; ++y) {
    for (int x = 0; x < kMaskSide; ++x) {
      const bool touches = x >= 15 && x <= 32 && y >= 15 && y <= 32;
      const bool is_far = x < 14 || x > 33 || y < 14 || y > 33;
      const float mask = At(tiles, {x, y}, 0);
      EXPECT_TRUE(!touches || mask == 1.0f) << x << " " << y;
      EXPECT_TRUE(!is_far || mask == 0.0f) << x << " " << y;
    }
  }
}

// Two sleeves that share a texture.
TEST(SkinnedMasks, PointsThatShareATexelMustHaveTheSameMasks) {
  const std::vector<SkinnedShare> shares = {ShareOf(1, 0, wrinkle::LambdaMode::kSmooth),
                                            ShareOf(3, 0, wrinkle::LambdaMode::kSmooth)};
  const glm::vec2 low(0.1f);
  const glm::vec2 high(0.9f);
  const character::Mesh left = Sheet(low, high, Across(0, 1));
  const character::Mesh right = Sheet(low, high, Across(0, 3));
  const character::Mesh mirrored = Sheet({0.9f, 0.1f}, {0.1f, 0.9f}, Across(0, 1));
  const character::Mesh bare = Sheet(low, high, Across(0, 0));
  const character::Mesh elsewhere = Sheet({0.9f, 0.1f}, {1.7f, 0.9f}, Across(0, 3));
  EXPECT_TRUE(MasksOf({left}, shares).is_unique());
  EXPECT_TRUE(MasksOf({left, left}, shares).is_unique());
  EXPECT_FALSE(MasksOf({left, right}, shares).is_unique());
  EXPECT_FALSE(MasksOf({left, mirrored}, shares).is_unique());
  EXPECT_FALSE(MasksOf({left, bare}, shares).is_unique());
  EXPECT_FALSE(MasksOf({left, elsewhere}, shares).is_unique());  // the texture repeats
  EXPECT_TRUE(MasksOf({left, right}, {}).is_unique());           // no joint raises a mask
}

// Holds for any texture layout.
TEST(SkinnedMasks, NoMasksAtAllAreUnique) {
  const character::Mesh repeated = Sheet({0.0f, 0.0f}, {90.0f, 90.0f}, Across(0, 1));
  EXPECT_TRUE(MasksOf({repeated}, {ShareOf(3, 0, wrinkle::LambdaMode::kSmooth)}).is_unique());
  EXPECT_FALSE(MasksOf({repeated}, {ShareOf(1, 0, wrinkle::LambdaMode::kSmooth)}).is_unique());
}

TEST(SkinnedMasks, TooManyMasksOfAVertexStayInTheFragment) {
  const character::Mesh sheet = Sheet(glm::vec2(0.1f), glm::vec2(0.9f), Across(0, 1));
  std::vector<SkinnedShare> shares;
  for (int column = 0; column < 16; ++column) {
    shares.push_back(ShareOf(1, column, wrinkle::LambdaMode::kLinear));
  }
  EXPECT_TRUE(MasksOf({sheet}, shares).is_unique());
  for (int column = 16; column < 80; ++column) {
    shares.push_back(ShareOf(1, column, wrinkle::LambdaMode::kLinear));
  }
  const SkinnedMasks masks = MasksOf({sheet}, shares);
  EXPECT_FALSE(masks.is_unique());
  EXPECT_TRUE(masks.channels().empty());
  EXPECT_TRUE(masks.regions().empty());
}

TEST(SkinnedMasks, TrianglesThatAreLinesInTheTextureAreNotUnique) {
  const std::vector<SkinnedShare> shares = {ShareOf(1, 0, wrinkle::LambdaMode::kLinear)};
  EXPECT_FALSE(MasksOf({Sheet(glm::vec2(0.5f), {0.5f, 0.9f}, Across(0, 1))}, shares).is_unique());
  EXPECT_TRUE(MasksOf({Sheet(glm::vec2(0.5f), {0.5f, 0.9f}, Across(1, 1))}, shares).is_unique());
}

// One region for the triangles that each joint affects.
TEST(SkinnedMasks, RegionsAreTheTrianglesThatAJointAffects) {
  const auto half = [](float u, float, character::Vertex* vertex) {
    vertex->joints[0] = u > 0.6f ? 2 : 0;
  };
  const SkinnedMasks masks = MasksOf({Sheet(glm::vec2(0.0f), glm::vec2(1.0f), half)},
                                     {ShareOf(2, 1, wrinkle::LambdaMode::kSmooth)});
  ASSERT_EQ(masks.regions().size(), 1u);
  EXPECT_EQ(masks.regions()[0].channel, 0);
  const std::vector<glm::mat4> rest(kJoints, glm::mat4(1.0f));
  glm::mat4 projection(1.0f);
  const auto extent = masks.regions()[0].bounds.Look({rest, {}}, projection);
  EXPECT_NEAR(extent.low.x, 0.5f, 1e-5f);  // the last vertex that is not affected
  EXPECT_NEAR(extent.high.x, 1.0f, 1e-5f);
  EXPECT_NEAR(masks.regions()[0].uv_per_metre, 1.0f, 1e-4f);
}

}  // namespace
}  // namespace furrow::render

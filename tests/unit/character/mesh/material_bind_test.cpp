// SPDX-License-Identifier: Apache-2.0
#include "character/mesh/material_bind.h"

#include <cmath>
#include <limits>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace furrow::character {
namespace {

// Shape 0 reddens and shines, shape 1 darkens and slides, shape 2 stretches.
const std::vector<MaterialBind> kBinds = {
    {.shape = 0, .base_colour = {0.5f, -0.25f, 0.0f, 0.5f}, .emission = {0.0f, 2.0f, 0.0f}},
    {.shape = 1, .base_colour = {-0.25f, -0.25f, -0.25f, 0.0f}, .uv_offset = {0.5f, 0.0f}},
    {.shape = 2, .uv_scale = {1.0f, -0.5f}}};

Material Grey() {
  Material material;
  material.base_colour = {0.5f, 0.5f, 0.5f, 0.5f};
  material.emission = {0.125f, 0.0f, 0.0f};
  return material;
}

MaterialLook LookAt(const std::vector<float>& shapes, const Material& material = Grey()) {
  return LookOf(material, kBinds, shapes);
}

TEST(MaterialBind, WithoutWeightsTheMaterialStays) {
  for (const std::vector<float>& shapes : {std::vector<float>{}, std::vector<float>{0, 0, 0},
                                           std::vector<float>{-1.0f, std::nanf(""), 0.0f}}) {
    const MaterialLook look = LookAt(shapes);
    EXPECT_EQ(look.base_colour, Grey().base_colour);
    EXPECT_EQ(look.emission, Grey().emission);
    EXPECT_EQ(look.texture_scale, glm::vec2(1.0f));
    EXPECT_EQ(look.texture_offset, glm::vec2(0.0f));
  }
}

// base + sum of weight * (target - base)
TEST(MaterialBind, ChangesAddUp) {
  const MaterialLook look = LookAt({0.5f, 1.0f, 0.0f});
  EXPECT_EQ(look.base_colour, glm::vec4(0.5f, 0.125f, 0.25f, 0.75f));
  EXPECT_EQ(look.emission, glm::vec3(0.125f, 1.0f, 0.0f));
  EXPECT_EQ(look.texture_offset, glm::vec2(0.5f, 0.0f));
}

TEST(MaterialBind, WeightsAndColoursHaveLimits) {
  EXPECT_EQ(LookAt({9.0f, 0.0f, 0.0f}), LookAt({1.0f, 0.0f, 0.0f}));
  const std::vector<MaterialBind> twice = {kBinds[0], kBinds[0], kBinds[0]};
  const MaterialLook look = LookOf(Grey(), twice, std::vector<float>{1.0f});
  EXPECT_EQ(look.base_colour, glm::vec4(1.0f, 0.0f, 0.5f, 1.0f));
  EXPECT_EQ(LookOf(Grey(), kBinds, std::vector<float>{1.0f}), LookAt({1.0f, 0.0f, 0.0f}))
      << "binds of shapes without a weight do nothing";
}

// Binds change the UVs of the textures at rest, which a tile of an atlas has moved before.
TEST(MaterialBind, FollowTheTileOfAnAtlas) {
  Material tile = Grey();
  tile.texture_scale = {2.0f, 2.0f};
  tile.texture_offset = {-1.0f, 0.5f};
  const MaterialLook look = LookAt({0.0f, 1.0f, 1.0f}, tile);
  const glm::vec2 uv(0.7f, 0.3f);
  const glm::vec2 at_rest = uv * tile.texture_scale + tile.texture_offset;
  const glm::vec2 expected = at_rest * glm::vec2(2.0f, 0.5f) + glm::vec2(0.5f, 0.0f);
  EXPECT_LT(glm::distance(uv * look.texture_scale + look.texture_offset, expected), 1e-6f);
}

}  // namespace
}  // namespace furrow::character

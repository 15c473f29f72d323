// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/cloth/cloth_effect.h"

#include <algorithm>
#include <memory>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "base/scalar.h"
#include "tests/unit/authoring/bake/toys.h"

namespace furrow::authoring {
namespace {

using glm::mat4;
using glm::vec3;

const vec3 kX(1, 0, 0), kY(0, 1, 0);

// A sheet of cloth of 20 x 20 cm that hangs in the plane z = 0; gravity points to -y.
class Worn : public testing::Test {
 protected:
  Worn() : mesh_(toys::Sheet(0.2f, 0.2f, 8, 8)) {
    const character::Mesh* const meshes[] = {&mesh_};
    surface_ = std::make_unique<Surface>(meshes);
    fine_ = std::make_unique<FineMesh>(*surface_, 0.01f);
  }

  [[nodiscard]] WornCloth Cloth(float ease, const ClothEase& cut = {}) const {
    const std::size_t count = fine_->vertices().size();
    return {.cut = std::vector<mat4>(2, mat4(1.0f)),
            .room = std::vector<float>(count, 1.0f),
            .eases = std::vector<ClothEase>(count, cut),
            .fabric = {.wavelength = 0.03f, .hanging = 1.7f},
            .ease = ease};
  }
  [[nodiscard]] ClothEffect Measured(const WornCloth& cloth, const mat4& bent = mat4(1.0f)) const {
    return MeasureClothEffect(*fine_, cloth, std::vector<mat4>(2, bent), {});
  }
  // The mean share of its length that cloth along the unit vector hides.
  [[nodiscard]] static float Hidden(const ClothEffect& effect, const vec3& along) {
    float sum = 0.0f;
    for (const glm::mat3& slack : effect.slack) sum += glm::dot(along, slack * along);
    return sum / static_cast<float>(effect.slack.size());
  }

  character::Mesh mesh_;
  std::unique_ptr<Surface> surface_;
  std::unique_ptr<FineMesh> fine_;
};

TEST_F(Worn, HangingClothIsTooWideRatherThanTooLong) {
  const ClothEffect effect = Measured(Cloth(0.1f));
  EXPECT_GT(Hidden(effect, kX), 0.04f);
  EXPECT_NEAR(Hidden(effect, kY), Hidden(effect, kX) / 9.0f, 1e-4f);
  for (const float width : effect.width) EXPECT_FLOAT_EQ(width, 1.7f);
  for (const float pressed : effect.pressed) EXPECT_EQ(pressed, 0.0f);
}

TEST_F(Worn, ClothOnAShoeStacksAlongGravity) {
  const ClothEffect effect = Measured(Cloth(0.15f, {.least = 1.0f, .stacks = 0.3f}));
  const ClothEffect hanging = Measured(Cloth(0.15f, {.least = 1.0f}));
  EXPECT_NEAR(Hidden(effect, kY) - Hidden(hanging, kY), 0.3f, 1e-3f);
  EXPECT_NEAR(Hidden(effect, kX) - Hidden(hanging, kX), 0.0f, 1e-3f);
  // It is pressed together, as by a bend.
  for (const float width : effect.width) EXPECT_NEAR(width, 1.0f, 1e-3f);
  for (const float pressed : effect.pressed) EXPECT_NEAR(pressed, 1.0f, 1e-3f);
}

TEST_F(Worn, TightClothDoesNotStack) {
  const ClothEffect effect = Measured(Cloth(0.0f, {.stacks = 0.3f}));
  for (const glm::mat3& slack : effect.slack) EXPECT_EQ(slack, glm::mat3(0.0f));
}

TEST_F(Worn, ClothThatLiesFlatHasNoEase) {
  const mat4 flat = glm::rotate(mat4(1.0f), -90.0f * kDegrees, kX);
  const ClothEffect effect = Measured(Cloth(0.1f, {.stacks = 0.3f}), flat);
  EXPECT_NEAR(Hidden(effect, kX), 0.0f, 1e-4f);
  EXPECT_NEAR(Hidden(effect, kY), 0.0f, 1e-4f);
}

TEST_F(Worn, NothingFoldsWithoutRoom) {
  WornCloth cloth = Cloth(0.1f, {.stacks = 0.3f});
  std::ranges::fill(cloth.room, 0.0f);
  const ClothEffect effect = Measured(cloth, toys::Squeeze(0.2f, 0.0f));
  for (const glm::mat3& slack : effect.slack) EXPECT_EQ(slack, glm::mat3(0.0f));
}

// A pull makes drag lines: wider apart and lower than folds that are pressed together.
TEST_F(Worn, APullDiffersFromCompression) {
  const ClothEffect pulled = Measured(Cloth(0.0f), toys::Squeeze(-0.25f, 0.0f));
  const ClothEffect pressed = Measured(Cloth(0.0f), toys::Squeeze(0.25f, 0.0f));
  EXPECT_LT(Hidden(pulled, kX), -0.1f);
  EXPECT_GT(Hidden(pressed, kX), 0.3f);
  for (std::size_t v = 0; v < pulled.slack.size(); ++v) {
    EXPECT_GT(pulled.width[v], pressed.width[v]);
    EXPECT_LT(pulled.height[v], pressed.height[v]);
    EXPECT_LT(pulled.pressed[v], pressed.pressed[v]);
  }
}

}  // namespace
}  // namespace furrow::authoring

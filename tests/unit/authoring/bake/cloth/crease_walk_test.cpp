// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/cloth/crease_walk.h"

#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/unit/authoring/bake/toys.h"

namespace furrow::authoring {
namespace {

using glm::vec3;

constexpr float kWalkWidth = 0.3f, kWalkHeight = 0.2f;  // metres

// A flat sheet, with creases along `direction`.
class Walks : public testing::Test {
 protected:
  Walks() : mesh_(toys::Sheet(kWalkWidth, kWalkHeight, 12, 8)) {
    const character::Mesh* const meshes[] = {&mesh_};
    surface_ = std::make_unique<Surface>(meshes);
    fine_ = std::make_unique<FineMesh>(*surface_, 0.01f);
  }

  [[nodiscard]] CreaseField Field(const vec3& direction) const {
    const std::size_t count = fine_->vertices().size();
    return {std::vector<vec3>(count, direction), std::vector<float>(count, 0.2f),
            std::vector<float>(count, 0.03f), std::vector<float>(count, 0.0f)};
  }
  [[nodiscard]] std::uint32_t Nearest(const vec3& place) const {
    std::uint32_t nearest = 0;
    for (std::uint32_t v = 1; v < fine_->positions().size(); ++v) {
      if (glm::distance(fine_->positions()[v], place) <
          glm::distance(fine_->positions()[nearest], place)) {
        nearest = v;
      }
    }
    return nearest;
  }
  struct End {
    vec3 place{0.0f};
    float walked = 0.0f;
  };
  // Walks to the border.
  [[nodiscard]] static End Walk(const CreaseWalk& walk, CreaseWalk::Spot spot) {
    End end;
    float step = 0.0f;
    for (int k = 0; k < 1000 && walk.Step(&spot, &step); ++k) {
      end.walked += step;
      end.place = walk.PlaceOf(spot);
    }
    return end;
  }

  character::Mesh mesh_;
  std::unique_ptr<Surface> surface_;
  std::unique_ptr<FineMesh> fine_;
};

TEST_F(Walks, FollowsTheFieldToTheBorderBothWays) {
  const CreaseField field = Field({1, 0, 0});
  const CreaseWalk walk(*fine_, field, 1);
  const std::uint32_t middle = Nearest({0.5f * kWalkWidth, 0.5f * kWalkHeight, 0.0f});
  const vec3 from = fine_->positions()[middle];
  std::optional<CreaseWalk::Spot> spot = walk.StartAt(middle);
  ASSERT_TRUE(spot);
  const End ahead = Walk(walk, *spot);
  spot->direction = -spot->direction;
  const End behind = Walk(walk, *spot);
  constexpr float kEdge = 0.014f;  // the last triangle is not crossed
  EXPECT_NEAR(ahead.place.x, kWalkWidth, kEdge);
  EXPECT_NEAR(behind.place.x, 0.0f, kEdge);
  for (const End& end : {ahead, behind}) {
    EXPECT_NEAR(end.place.y, from.y, kEdge);
    EXPECT_NEAR(end.place.z, 0.0f, 1e-6f);
    EXPECT_NEAR(end.walked, std::abs(end.place.x - from.x), kEdge);
  }
}

// Directions have no sign: an entry of the field may point either way.
TEST_F(Walks, GoesOnWhereTheFieldPointsBack) {
  CreaseField field = Field({0, 1, 0});
  for (std::size_t v = 0; v < field.along.size(); v += 2) field.along[v] = -field.along[v];
  const CreaseWalk walk(*fine_, field, 1);
  std::optional<CreaseWalk::Spot> spot = walk.StartAt(Nearest({0.1f, 0.02f, 0.0f}));
  ASSERT_TRUE(spot);
  spot->direction = {0, 1, 0};
  EXPECT_NEAR(Walk(walk, *spot).place.y, kWalkHeight, 0.014f);
}

TEST_F(Walks, BendsNoMoreSharplyThanCloth) {
  // The field turns by a right angle at x = 0.15.
  CreaseField field = Field({1, 0, 0});
  for (std::size_t v = 0; v < field.along.size(); ++v) {
    if (fine_->positions()[v].x > 0.15f) field.along[v] = {0, 1, 0};
  }
  const CreaseWalk walk(*fine_, field, 1);
  std::optional<CreaseWalk::Spot> spot = walk.StartAt(Nearest({0.05f, 0.05f, 0.0f}));
  ASSERT_TRUE(spot);
  vec3 before = spot->direction;
  float step = 0.0f, turned = 0.0f;
  for (int k = 0; k < 1000 && walk.Step(&*spot, &step); ++k) {
    EXPECT_GT(glm::dot(before, spot->direction), 0.8f);
    before = spot->direction;
    turned = before.y;
  }
  EXPECT_GT(turned, 0.95f);
}

TEST_F(Walks, StartsNowhereOnATriangleWithoutArea) {
  character::Mesh flat = toys::Sheet(kWalkWidth, 0.0f, 3, 1);
  const character::Mesh* const meshes[] = {&flat};
  const Surface surface(meshes);
  const FineMesh fine(surface, 0.01f);
  const std::size_t count = fine.vertices().size();
  const CreaseField field{std::vector<vec3>(count, vec3(1, 0, 0)), std::vector<float>(count, 0.2f),
                          std::vector<float>(count, 0.03f), std::vector<float>(count, 0.0f)};
  const CreaseWalk walk(fine, field, 1);
  for (std::uint32_t v = 0; v < count; ++v) EXPECT_FALSE(walk.StartAt(v));
}

}  // namespace
}  // namespace furrow::authoring

// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/unit/authoring/bake/toys.h"

namespace furrow::authoring {
namespace {

constexpr float kSide = 0.1f;

BakeStroke Across(BakeStroke::Kind kind) {
  BakeStroke stroke;
  stroke.name = "line";
  stroke.kind = kind;
  stroke.maps = {"folds"};
  // A vertical line through the middle of the sheet, slightly above its surface.
  stroke.points = {{0.05f, 0.02f, 0.004f}, {0.05f, 0.05f, 0.004f}, {0.05f, 0.08f, 0.004f}};
  stroke.width_mm = 3.0f;
  stroke.depth_mm = 0.8f;
  stroke.taper = 0.4f;
  return stroke;
}

character::Character StrokeSheet() { return toys::Wearing(toys::Sheet(kSide, kSide, 20, 20)); }

TEST(Strokes, FoldWithoutAnyPose) {
  const BakedMap map =
      toys::BakeFolds(StrokeSheet(), {}, toys::Exact(), {Across(BakeStroke::Kind::kFold)});
  EXPECT_EQ(map.statistics.strokes, 1);
  EXPECT_NEAR(map.height_mm[toys::At(map, 128, 128)], -0.8f, 0.08f);
  EXPECT_LT(map.cavity[toys::At(map, 128, 128)], 0.95f);
  EXPECT_EQ(map.height_mm[toys::At(map, 20, 128)], 0.0f);
  // The depth tapers to zero at the ends, at 1/5 and 4/5 of the height.
  EXPECT_NEAR(map.height_mm[toys::At(map, 128, 52)], 0.0f, 0.05f);
}

TEST(Strokes, OverrideStrainOnlyWhereTheyLie) {
  const std::vector<BakePose> poses = {toys::Pose(toys::Squeeze(0.2f, 90.0f))};
  const BakedMap strain = toys::BakeFolds(StrokeSheet(), poses, toys::Exact());
  BakeStroke stroke = Across(BakeStroke::Kind::kFold);
  stroke.taper = 0.1f;
  const BakedMap both = toys::BakeFolds(StrokeSheet(), poses, toys::Exact(), {stroke});
  float off = 0.0f, away = 0.0f, strongest = 0.0f;
  for (int y = 100; y < 156; ++y) {
    off = std::max(off, std::abs(both.height_mm[toys::At(both, 128, y)] + 0.8f));
    away = std::max(away, std::abs(both.height_mm[toys::At(both, 40, y)] -
                                   strain.height_mm[toys::At(strain, 40, y)]));
    strongest = std::max(strongest, std::abs(strain.height_mm[toys::At(strain, 128, y)]));
  }
  EXPECT_GT(strongest, 0.8f);
  EXPECT_LT(off, 0.1f);
  EXPECT_LT(away, 0.01f);
}

TEST(Strokes, ExcludeStrain) {
  BakeStroke stroke = Across(BakeStroke::Kind::kExclude);
  stroke.width_mm = 35.0f;
  const BakedMap map = toys::BakeFolds(StrokeSheet(), {toys::Pose(toys::Squeeze(0.2f, 90.0f))},
                                       toys::Exact(), {stroke});
  float middle = 0.0f, border = 0.0f;
  for (int y = 100; y < 156; ++y) {
    middle = std::max(middle, std::abs(map.height_mm[toys::At(map, 128, y)]));
    border = std::max(border, std::abs(map.height_mm[toys::At(map, 20, y)]));
  }
  EXPECT_GT(border, 0.8f);
  EXPECT_LT(middle, 0.25f * border);
  EXPECT_EQ(map.statistics.strokes, 0);
}

TEST(Strokes, DirectFoldsAlongTheStroke) {
  BakeStroke stroke = Across(BakeStroke::Kind::kDirection);
  stroke.width_mm = 30.0f;
  // With vertical compression folds would be horizontal. The stroke is vertical.
  const BakedMap map = toys::BakeFolds(StrokeSheet(), {toys::Pose(toys::Squeeze(0.2f, 90.0f))},
                                       toys::Exact(), {stroke});
  double level = 0.0, upright = 0.0;
  for (int y = 110; y < 146; ++y) {
    for (int x = 120; x < 136; ++x) {
      const std::size_t i = toys::At(map, x, y);
      upright += static_cast<double>(std::abs(map.derivative[2 * i]));
      level += static_cast<double>(std::abs(map.derivative[2 * i + 1]));
    }
  }
  EXPECT_GT(upright, 3.0 * level);
}

TEST(Strokes, MeasureDistanceAlongTheSurface) {
  // Two sheets 1 mm apart. The line lies on the upper sheet.
  character::Mesh mesh = toys::Grid(10, 10, [](float u, float v) {
    return toys::Point{{0.05f * u, 0.05f * v, 0.001f}, {0.45f * u, 1.0f - v}, 0.0f};
  });
  toys::Append(
      toys::Grid(
          10, 10,
          [](float u, float v) {
            return toys::Point{{0.05f * u, 0.05f * v, 0.0f}, {0.5f + 0.45f * u, 1.0f - v}, 0.0f};
          }),
      &mesh);
  BakeStroke stroke = Across(BakeStroke::Kind::kFold);
  stroke.points = {{0.025f, 0.01f, 0.002f}, {0.025f, 0.04f, 0.002f}};
  const BakedMap map = toys::BakeFolds(toys::Wearing(std::move(mesh)), {}, toys::Exact(), {stroke});
  float upper = 0.0f, lower = 0.0f;
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      if (!map.covered[toys::At(map, x, y)]) continue;
      float& most = x < map.width / 2 ? upper : lower;
      most = std::max(most, std::abs(map.height_mm[toys::At(map, x, y)]));
    }
  }
  EXPECT_NEAR(upper, 0.8f, 0.1f);
  EXPECT_EQ(lower, 0.0f);
}

// Fans often contain triangles with two equal corners. Strokes must not be placed on them.
TEST(Strokes, IgnoreTrianglesWithoutArea) {
  const BakeStroke stroke = Across(BakeStroke::Kind::kFold);
  const BakedMap whole = toys::BakeFolds(StrokeSheet(), {}, toys::Exact(), {stroke});
  const std::uint32_t a = 0, b = 220;  // a far corner, and a vertex beside the line
  const std::uint32_t kCorners[][3] = {{a, a, b}, {a, b, a}, {b, a, a}, {b, b, b}};
  for (const auto& corners : kCorners) {
    for (const std::size_t place : {0u, 300u, 1200u}) {
      character::Character character = StrokeSheet();
      std::vector<std::uint32_t>& indices = character.meshes[0].indices;
      indices.insert(indices.begin() + static_cast<std::ptrdiff_t>(place), corners, corners + 3);
      const BakedMap map = toys::BakeFolds(character, {}, toys::Exact(), {stroke});
      EXPECT_TRUE(map.height_mm == whole.height_mm) << corners[0] << " at " << place;
    }
  }
}

TEST(Strokes, FarFromTheSurfaceAreRejectedByName) {
  BakeStroke stroke = Across(BakeStroke::Kind::kFold);
  for (glm::vec3& point : stroke.points) point.z = 0.019f;
  EXPECT_TRUE(Bake(StrokeSheet(), {}, {&stroke, 1}, toys::Exact()).ok());
  stroke.points[1].z = 0.06f;
  const Status refused = Bake(StrokeSheet(), {}, {&stroke, 1}, toys::Exact()).status();
  EXPECT_EQ(refused.code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(refused.where(), "stroke 'line'");
  stroke.width_mm = 20.0f;  // a stroke may lie up to four widths from the surface
  EXPECT_TRUE(Bake(StrokeSheet(), {}, {&stroke, 1}, toys::Exact()).ok());
}

TEST(Strokes, CountOnlyIfTheyCoverTexels) {
  character::Character sheet = StrokeSheet();
  for (character::Vertex& vertex : sheet.meshes[0].vertices)
    vertex.uv.x *= 2.0f;  // half of the sheet is outside the picture
  BakeStroke off = Across(BakeStroke::Kind::kFold);
  for (glm::vec3& point : off.points) point.x = 0.08f;
  BakeStroke on = off;
  for (glm::vec3& point : on.points) point.x = 0.02f;
  EXPECT_EQ(toys::BakeFolds(sheet, {}, toys::Exact(), {on}).statistics.strokes, 1);
  EXPECT_EQ(toys::BakeFolds(sheet, {}, toys::Exact(), {on, off}).statistics.strokes, 1);
}

TEST(Strokes, TooManyPiecesExceedTheLimit) {
  BakeStroke stroke = Across(BakeStroke::Kind::kFold);
  stroke.width_mm = 0.1f;
  stroke.depth_mm = 0.1f;
  stroke.points.clear();
  for (int i = 0; i < 1024; ++i) stroke.points.push_back({i % 2 == 0 ? 0.0f : 0.1f, 0.05f, 0.0f});
  stroke.smooth = false;
  const std::vector<BakeStroke> strokes(4, stroke);  // 65,000 pieces each
  EXPECT_EQ(Bake(StrokeSheet(), {}, strokes, toys::Exact()).status().code(), StatusCode::kLimit);
}

}  // namespace
}  // namespace furrow::authoring

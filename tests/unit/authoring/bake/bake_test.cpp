// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/bake.h"

#include <functional>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/authoring/bake/toys.h"

namespace furrow::authoring {
namespace {

character::Character Sheet() { return toys::Wearing(toys::Sheet(0.1f, 0.1f, 10, 10)); }

BakeOptions Small() {
  BakeOptions options;
  options.size = 64;
  options.threads = 1;
  return options;
}

// A valid request. Each test makes one thing wrong.
struct Request {
  character::Character character = Sheet();
  std::vector<BakePose> poses = {toys::Pose(toys::Squeeze(0.2f, 0.0f))};
  std::vector<BakeStroke> strokes;
  BakeOptions options = Small();

  [[nodiscard]] StatusCode Code() const {
    return Bake(character, poses, strokes, options).status().code();
  }
};

BakeStroke Line() {
  BakeStroke stroke;
  stroke.maps = {"folds"};
  stroke.points = {{0.02f, 0.02f, 0.0f}, {0.08f, 0.08f, 0.0f}};
  return stroke;
}

TEST(Bake, RejectsInvalidRequests) {
  EXPECT_EQ(Request().Code(), StatusCode::kOk);
  const std::vector<std::function<void(Request*)>> kWrong = {
      [](Request* r) { r->poses[0].map = "none"; },
      [](Request* r) { r->poses[0].region = "none"; },
      [](Request* r) { r->poses[0].skin_matrices.pop_back(); },
      [](Request* r) { r->poses[0].weight = 0.0f; },
      [](Request* r) { r->poses[0].weight = 1.5f; },
      [](Request* r) { r->strokes = {Line()}, r->strokes[0].maps = {}; },
      [](Request* r) { r->strokes = {Line()}, r->strokes[0].maps = {"none"}; },
      [](Request* r) { r->strokes = {Line()}, r->strokes[0].region = "none"; },
      [](Request* r) { r->strokes = {Line()}, r->strokes[0].points.resize(1); },
      [](Request* r) { r->strokes = {Line()}, r->strokes[0].width_mm = 0.0f; },
      [](Request* r) { r->strokes = {Line()}, r->strokes[0].depth_mm = 51.0f; },
      [](Request* r) { r->strokes = {Line()}, r->strokes[0].ridge = 1.1f; },
      [](Request* r) { r->strokes = {Line()}, r->strokes[0].taper = 0.0f; },
      [](Request* r) { r->strokes = {Line()}, r->strokes[0].wavelength_mm = -1.0f; },
      [](Request* r) { r->strokes = {Line()}, r->strokes[0].wavelength_mm = 0.1f; },
      [](Request* r) { r->options.size = 63; },
      [](Request* r) { r->options.size = 4097; },
      [](Request* r) { r->options.threads = 0; },
      [](Request* r) {
        r->options.eases = {{"elbow", {.looser = 0.9f}}};
      },
      [](Request* r) {
        r->options.eases = {{"elbow", {.least = 1.1f}}};
      },
      [](Request* r) {
        r->options.eases = {{"elbow", {.least = -0.1f}}};
      },
      [](Request* r) {
        r->options.eases = {{"knee", {.feeds = 4.1f}}};
      },
      [](Request* r) {
        r->options.eases = {{"ankle", {.stacks = 0.9f}}};
      },
      [](Request* r) { r->options.fabric.bending = 0.0f; },
      [](Request* r) { r->options.fabric.weight = 0.0f; },
      [](Request* r) { r->options.fabric.thickness = std::numeric_limits<float>::infinity(); },
      [](Request* r) { r->options.fabrics = {{"knee", {.name = "air", .stretching = 0.0f}}}; },
      [](Request* r) { r->options.depth = -1.0f; },
      [](Request* r) { r->options.skin.wavelength_mm = 0.0f; },
      [](Request* r) { r->options.skin.share = 1.1f; },
      [](Request* r) { r->options.skin.variation = 0.6f; },
      [](Request* r) { r->options.cloth.max_compression = 1.0f; },
      [](Request* r) { r->options.cloth.smoothing_mm = std::numeric_limits<float>::quiet_NaN(); },
      [](Request* r) {
        r->options.wavelengths = {{"brow", 0.0f}};
      },
  };
  for (std::size_t i = 0; i < kWrong.size(); ++i) {
    Request request;
    kWrong[i](&request);
    EXPECT_EQ(request.Code(), StatusCode::kInvalidArgument) << i;
  }
}

TEST(Bake, RejectsNonFiniteNumbers) {
  Request request;
  request.poses[0].skin_matrices[1][2][0] = std::numeric_limits<float>::infinity();
  EXPECT_EQ(request.Code(), StatusCode::kNonFinite);
  request = Request();
  request.strokes = {Line()};
  request.strokes[0].points[1].y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(request.Code(), StatusCode::kNonFinite);
}

TEST(Bake, RejectsUnsuitableSurfaces) {
  Request request;
  request.character.rig.wrinkle_maps[0].surface = wrinkle::WrinkleMap::Surface::kCloth;
  EXPECT_EQ(request.Code(), StatusCode::kInvalidArgument);  // no mesh is cloth
  request = Request();
  for (character::Vertex& vertex : request.character.meshes[0].vertices)
    vertex.uv = glm::vec2(0.5f);
  EXPECT_EQ(request.Code(), StatusCode::kInvalidArgument);  // no UVs
  request = Request();
  for (character::Vertex& vertex : request.character.meshes[0].vertices) vertex.position.y = 0.0f;
  EXPECT_EQ(request.Code(), StatusCode::kInvalidArgument);  // no area
}

TEST(Bake, BakesOnlyMapsWithPoses) {
  Request request;
  wrinkle::WrinkleMap other = request.character.rig.wrinkle_maps[0];
  other.name = "other";
  request.character.rig.wrinkle_maps.insert(request.character.rig.wrinkle_maps.begin(), other);
  Result<BakedMaps> one = Bake(request.character, request.poses, {}, request.options);
  ASSERT_TRUE(one.ok());
  ASSERT_EQ(one.value().maps.size(), 1u);
  EXPECT_EQ(one.value().maps[0].map, "folds");
  BakeStroke stroke = Line();
  stroke.maps = {"other", "folds"};
  const std::vector<BakeStroke> strokes = {stroke};
  Result<BakedMaps> two = Bake(request.character, request.poses, strokes, request.options);
  ASSERT_TRUE(two.ok());
  ASSERT_EQ(two.value().maps.size(), 2u);
  EXPECT_EQ(two.value().maps[0].map, "other");  // in the order of the rig
}

TEST(Bake, ReportsProgressAndCanBeCancelled) {
  Request request;
  std::vector<float> told;
  const auto listen = [&](float done) {
    told.push_back(done);
    return true;
  };
  ASSERT_TRUE(Bake(request.character, request.poses, {}, request.options, listen).ok());
  ASSERT_GE(told.size(), 3u);
  EXPECT_EQ(told.front(), 0.0f);
  EXPECT_EQ(told.back(), 1.0f);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  for (std::size_t stop = 0; stop < told.size(); ++stop) {
    std::size_t calls = 0;
    const auto cancel = [&](float) { return calls++ < stop; };
    EXPECT_EQ(Bake(request.character, request.poses, {}, request.options, cancel).status().code(),
              StatusCode::kUnavailable)
        << stop;
  }
}

TEST(Bake, AppliesAPoseOnlyUnderItsRegionsMask) {
  Request request;
  character::Picture mask;
  mask.name = "mask";
  mask.width = 2;
  mask.height = 1;
  mask.channels = 1;
  mask.pixels = {255, 0};  // the left half
  request.character.pictures.push_back(mask);
  request.character.rig_pictures.emplace_back("mask", 0);
  request.character.rig.regions[0].mask = {.texture = "mask"};
  request.poses[0].region = "patch";
  request.options = toys::Exact();
  request.options.wavelengths = {{"patch", 5.0f}};
  const BakedMap map = toys::BakeFolds(request.character, request.poses, request.options);
  float left = 0.0f, right = 0.0f;
  int valleys = 0;
  for (int x = 8; x < 256; ++x) {
    const float height = map.height_mm[toys::At(map, x, 128)];
    if (x < 100) left = std::max(left, std::abs(height));
    if (x > 190) right = std::max(right, std::abs(height));
    if (x < 108 && map.height_mm[toys::At(map, x - 1, 128)] < 0.0f && height >= 0.0f) ++valleys;
  }
  EXPECT_GT(left, 0.3f);
  EXPECT_EQ(right, 0.0f);
  EXPECT_NEAR(valleys, 8, 1);  // 39 mm with the region's own folds of 5 mm
  ASSERT_EQ(map.masks.size(), 1u);
  EXPECT_EQ(map.masks[0].region, "patch");
  EXPECT_EQ(map.masks[0].width, 64);
  EXPECT_NEAR(map.masks[0].texels[32 * 64 + 10], 1.0f, 1e-3f);
}

TEST(Bake, CountsTexelsOfOverlappingTriangles) {
  Request request;
  EXPECT_EQ(toys::BakeFolds(request.character, request.poses, request.options)
                .statistics.overlapping_texels,
            0);
  toys::Append(character::Mesh(request.character.meshes[0]), &request.character.meshes[0]);
  EXPECT_GT(toys::BakeFolds(request.character, request.poses, request.options)
                .statistics.overlapping_texels,
            64 * 64 / 2);
}

TEST(Bake, AgeScalesTheDepth) {
  Request request;
  request.options = toys::Exact();
  const float young =
      toys::BakeFolds(request.character, request.poses, request.options).statistics.deepest_mm;
  request.options.skin.depth = 1.5f;
  const float old =
      toys::BakeFolds(request.character, request.poses, request.options).statistics.deepest_mm;
  EXPECT_NEAR(old, 1.5f * young, 1e-4f);
}

}  // namespace
}  // namespace furrow::authoring

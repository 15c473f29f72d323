// SPDX-License-Identifier: Apache-2.0
//
// Folds from strain must keep the length of the surface, run across its compression, be continuous
// across UV seams, and be absent without compression.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "authoring/bake/surface/compression.h"
#include "authoring/paint/surface_texels.h"
#include "tests/unit/authoring/bake/toys.h"

namespace furrow::authoring {
namespace {

using glm::vec2;
using glm::vec3;

constexpr float kWidth = 0.1f;  // width of the sheet, metres

// The mean length of the displaced rows of a compressed sheet, as a fraction of their length at
// rest. `compression` is along x. Uses only the heights, and excludes a border of 1.5 wavelengths.
float ArcOverRest(const BakedMap& map, float compression) {
  const float texel = kWidth / static_cast<float>(map.width);
  const int border = static_cast<int>(0.015f / texel);
  double arc = 0.0, rest = 0.0;
  for (int y = border; y < map.height - border; ++y) {
    for (int x = border; x + 1 < map.width - border; ++x) {
      const float rise =
          0.001f * (map.height_mm[toys::At(map, x + 1, y)] - map.height_mm[toys::At(map, x, y)]);
      arc += std::hypot((1.0f - compression) * texel, rise);
      rest += texel;
    }
  }
  return static_cast<float>(arc / rest);
}

class ArcLength : public ::testing::TestWithParam<float> {};

TEST_P(ArcLength, DisplacedSurfaceIsAsLongAsAtRest) {
  const float compression = GetParam();
  const character::Character sheet = toys::Wearing(toys::Sheet(kWidth, kWidth, 20, 20));
  for (const float sharpness : {0.0f, 0.7f}) {
    BakeOptions options = toys::Exact();
    options.skin.sharpness = sharpness;
    const BakedMap map =
        toys::BakeFolds(sheet, {toys::Pose(toys::Squeeze(compression, 0.0f))}, options);
    EXPECT_NEAR(ArcOverRest(map, compression), 1.0f, 0.02f) << "sharpness " << sharpness;
  }
}

INSTANTIATE_TEST_SUITE_P(Compressions, ArcLength,
                         ::testing::Values(0.02f, 0.1f, 0.25f, 0.4f, 0.6f));

TEST(Folds, KeepTheMeanLengthWithVaryingDepth) {
  const character::Character sheet = toys::Wearing(toys::Sheet(kWidth, kWidth, 20, 20));
  BakeOptions options = toys::Exact();
  options.skin.variation = 0.4f;
  options.skin.wavelength_mm = 5.0f;
  options.size = 512;
  const BakedMap map = toys::BakeFolds(sheet, {toys::Pose(toys::Squeeze(0.2f, 0.0f))}, options);
  EXPECT_NEAR(ArcOverRest(map, 0.2f), 1.0f, 0.05f);
}

TEST(Folds, TakeUpTheirShareOfTheCompression) {
  const character::Character sheet = toys::Wearing(toys::Sheet(kWidth, kWidth, 20, 20));
  BakeOptions options = toys::Exact();
  options.skin.share = 0.5f;
  const BakedMap map = toys::BakeFolds(sheet, {toys::Pose(toys::Squeeze(0.3f, 0.0f))}, options);
  EXPECT_NEAR(ArcOverRest(map, 0.15f), 1.0f, 0.02f);
}

TEST(Folds, AreOneWavelengthApart) {
  const character::Character sheet = toys::Wearing(toys::Sheet(kWidth, kWidth, 20, 20));
  const BakedMap map =
      toys::BakeFolds(sheet, {toys::Pose(toys::Squeeze(0.2f, 0.0f))}, toys::Exact());
  int crossings = 0;
  const int middle = map.height / 2;
  for (int x = 0; x + 1 < map.width; ++x) {
    const float here = map.height_mm[toys::At(map, x, middle)];
    const float next = map.height_mm[toys::At(map, x + 1, middle)];
    crossings += here < 0.0f && next >= 0.0f ? 1 : 0;
  }
  EXPECT_NEAR(crossings, 10, 1);  // 10 mm folds on 100 mm
}

TEST(Folds, AreNotFinerThanLocalTexels) {
  // The right half of the sheet fills a fifth of the picture: 7.8 mm per texel, 1.95 mm on the
  // left.
  character::Mesh mesh = toys::Grid(40, 20, [](float u, float v) {
    const float right = std::max(u - 0.5f, 0.0f);
    return toys::Point{
        {0.4f * u, 0.1f * v, 0.0f}, {1.6f * std::min(u, 0.5f) + 0.4f * right, 1.0f - v}, 0.0f};
  });
  BakeOptions options = toys::Exact();
  options.size = 128;
  options.skin.wavelength_mm = 2.0f;
  const BakedMap map = toys::BakeFolds(toys::Wearing(std::move(mesh)),
                                       {toys::Pose(toys::Squeeze(0.2f, 0.0f))}, options);
  const auto valleys = [&](int from, int to) {
    int count = 0;
    for (int x = from; x < to; ++x) {
      const float here = map.height_mm[toys::At(map, x, 64)];
      count += here < 0.0f && map.height_mm[toys::At(map, x + 1, 64)] >= 0.0f ? 1 : 0;
    }
    return count;
  };
  EXPECT_GE(valleys(5, 95), 15);
  EXPECT_LE(valleys(5, 95), 30);  // at least three texels each
  EXPECT_LE(valleys(106, 125), 7);
}

// The median angle in degrees between the slopes of a map and a direction in its plane.
float MedianAngle(const BakedMap& map, float degrees) {
  const vec2 across(std::cos(glm::radians(degrees)), std::sin(glm::radians(degrees)));
  std::vector<float> angles;
  for (std::size_t i = 0; i < map.covered.size(); ++i) {
    const vec2 slope(map.derivative[2 * i], map.derivative[2 * i + 1]);
    const float length = glm::length(slope);
    if (length < 0.05f) continue;
    const float cosine = std::min(std::abs(glm::dot(slope, across)) / length, 1.0f);
    angles.push_back(glm::degrees(std::acos(cosine)));
  }
  EXPECT_GT(angles.size(), map.covered.size() / 4);
  std::nth_element(angles.begin(), angles.begin() + angles.size() / 2, angles.end());
  return angles[angles.size() / 2];
}

TEST(Folds, RunAcrossTheCompressionInAnyDirection) {
  const character::Character sheet = toys::Wearing(toys::Sheet(kWidth, kWidth, 14, 14));
  BakeOptions options = toys::Exact();
  options.skin.variation = BakeMaterial().variation;  // the default variation
  for (const float degrees : {0.0f, 33.0f, 90.0f, 145.0f}) {
    const BakedMap map =
        toys::BakeFolds(sheet, {toys::Pose(toys::Squeeze(0.25f, degrees))}, options);
    EXPECT_LT(MedianAngle(map, degrees), 10.0f) << degrees;
  }
}

TEST(Folds, DerivativeIsMinusTheSlopeOfTheHeight) {
  const character::Character sheet = toys::Wearing(toys::Sheet(kWidth, kWidth, 20, 20));
  BakeOptions options = toys::Exact();
  options.size = 512;
  options.skin.variation = 0.3f;
  const BakedMap map = toys::BakeFolds(sheet, {toys::Pose(toys::Squeeze(0.2f, 30.0f))}, options);
  const float texel_mm = 1000.0f * kWidth / static_cast<float>(map.width);
  double error = 0.0, size = 0.0;
  for (int y = 1; y + 1 < map.height; ++y) {
    for (int x = 1; x + 1 < map.width; ++x) {
      const auto h = [&](int dx, int dy) { return map.height_mm[toys::At(map, x + dx, y + dy)]; };
      // The bitangent points up in the picture, opposite to y.
      const vec2 slope((h(1, 0) - h(-1, 0)) / (2.0f * texel_mm),
                       (h(0, -1) - h(0, 1)) / (2.0f * texel_mm));
      const std::size_t i = toys::At(map, x, y);
      const vec2 stored(map.derivative[2 * i], map.derivative[2 * i + 1]);
      error += static_cast<double>(glm::length(slope + stored));
      size += static_cast<double>(glm::length(slope));
    }
  }
  EXPECT_LT(error, 0.06 * size);
}

TEST(Folds, AreAbsentWithoutCompression) {
  const character::Character sheet = toys::Wearing(toys::Sheet(kWidth, kWidth, 10, 10));
  BakeOptions options;
  options.size = 128;
  const glm::mat4 still(1.0f);
  const glm::mat4 pulled = toys::Squeeze(-0.3f, 20.0f);
  for (const glm::mat4& pose : {still, pulled}) {
    const BakedMap map = toys::BakeFolds(sheet, {toys::Pose(pose)}, options);
    EXPECT_EQ(map.statistics.folded_texels, 0);
    EXPECT_EQ(map.statistics.deepest_mm, 0.0f);
    EXPECT_TRUE(std::all_of(map.derivative.begin(), map.derivative.end(),
                            [](float value) { return value == 0.0f; }));
    EXPECT_TRUE(std::all_of(map.cavity.begin(), map.cavity.end(),
                            [](float value) { return value == 1.0f; }));
  }
}

TEST(Folds, FadeTowardsUncompressedSurface) {
  // The right half follows joint 1, which does not move. The weights change in the middle third.
  character::Mesh mesh = toys::Grid(30, 10, [](float u, float v) {
    const float t = std::clamp(3.0f * u - 1.0f, 0.0f, 1.0f);
    return toys::Point{{0.2f * u, 0.1f * v, 0.0f}, {u, 1.0f - v}, t};
  });
  const character::Character sheet = toys::Wearing(std::move(mesh));
  BakeOptions options = toys::Exact();
  options.skin.threshold = 0.02f;
  const BakedMap map =
      toys::BakeFolds(sheet, {toys::Pose(toys::Squeeze(0.3f, 90.0f), glm::mat4(1.0f))}, options);
  const auto highest = [&](float from, float to) {
    float most = 0.0f;
    for (int y = 16; y < map.height - 16; ++y) {
      for (int x = static_cast<int>(from * 256); x < static_cast<int>(to * 256); ++x) {
        most = std::max(most, std::abs(map.height_mm[toys::At(map, x, y)]));
      }
    }
    return most;
  };
  EXPECT_GT(highest(0.1f, 0.25f), 1.0f);
  EXPECT_LT(highest(0.55f, 0.6f), 0.9f * highest(0.1f, 0.25f));
  EXPECT_EQ(highest(0.8f, 1.0f), 0.0f);
}

// A sheet unwrapped in two islands. The right island is turned by 90 degrees.
character::Mesh SeamedSheet() {
  character::Mesh mesh = toys::Grid(10, 20, [](float u, float v) {
    return toys::Point{{0.05f * u, 0.1f * v, 0.0f}, {0.02f + 0.4f * u, 0.98f - 0.8f * v}, 0.0f};
  });
  toys::Append(toys::Grid(10, 20,
                          [](float u, float v) {
                            return toys::Point{{0.05f + 0.05f * u, 0.1f * v, 0.0f},
                                               {0.5f + 0.4f * v, 0.1f + 0.3f * u},
                                               0.0f};
                          }),
               &mesh);
  return mesh;
}

TEST(Folds, AreContinuousAcrossUvSeams) {
  const character::Character sheet = toys::Wearing(SeamedSheet());
  BakeOptions options = toys::Exact();
  options.size = 512;
  options.skin.variation = 0.3f;
  const BakedMap map = toys::BakeFolds(sheet, {toys::Pose(toys::Squeeze(0.25f, 25.0f))}, options);
  const std::vector<SurfaceTexel> texels = RasterizeSurface(sheet.meshes[0], 512, 512);
  const auto height = [&](const SurfaceTexel& t) { return map.height_mm[toys::At(map, t.x, t.y)]; };
  // Neighbours on the sheet are within a texel of each other. Across the seam they lie in two
  // islands.
  constexpr float kNear = 0.0004f;
  const auto is_left = [](const SurfaceTexel& t) { return t.position.x < 0.05f; };
  float over_seam = 0.0f, inside = 0.0f;
  int pairs = 0;
  for (const SurfaceTexel& a : texels) {
    const bool at_seam = std::abs(a.position.x - 0.05f) < kNear;
    const bool at_reference = std::abs(a.position.x - 0.03f) < kNear;
    if ((!at_seam && !at_reference) || !is_left(a)) continue;
    for (const SurfaceTexel& b : texels) {
      if (glm::distance(a.position, b.position) > kNear) continue;
      const float jump = std::abs(height(a) - height(b));
      if (at_reference) inside = std::max(inside, jump);
      if (!at_seam || is_left(b)) continue;
      over_seam = std::max(over_seam, jump);
      ++pairs;
    }
  }
  EXPECT_GT(pairs, 100);
  EXPECT_GT(inside, 0.01f);
  EXPECT_LE(over_seam, 2.0f * inside);
}

TEST(Folds, DoNotDependOnTheNumberOfThreads) {
  const character::Character sheet = toys::Wearing(SeamedSheet());
  BakeOptions options;
  options.size = 256;
  options.threads = 1;
  const std::vector<BakePose> poses = {toys::Pose(toys::Squeeze(0.25f, 25.0f)),
                                       toys::Pose(toys::Squeeze(0.2f, 80.0f))};
  const BakedMap one = toys::BakeFolds(sheet, poses, options);
  options.threads = 3;
  const BakedMap three = toys::BakeFolds(sheet, poses, options);
  EXPECT_GT(one.statistics.folded_texels, 1000);
  EXPECT_TRUE(one.height_mm == three.height_mm);
  EXPECT_TRUE(one.derivative == three.derivative);
  EXPECT_TRUE(one.cavity == three.cavity);
  options.seed = 2;
  EXPECT_FALSE(one.height_mm == toys::BakeFolds(sheet, poses, options).height_mm);
}

TEST(Folds, DoNotLeakFromOneLipToTheOther) {
  // Two coincident sheets. Joint 0 compresses the first. The second follows joint 1, which rests.
  character::Mesh mesh = toys::Grid(12, 12, [](float u, float v) {
    return toys::Point{{0.05f * u, 0.05f * v, 0.0f}, {0.45f * u, 1.0f - v}, 0.0f};
  });
  toys::Append(
      toys::Grid(
          12, 12,
          [](float u, float v) {
            return toys::Point{{0.05f * u, 0.05f * v, 0.0f}, {0.5f + 0.45f * u, 1.0f - v}, 1.0f};
          }),
      &mesh);
  const character::Character lips = toys::Wearing(std::move(mesh));
  BakeOptions options = toys::Exact();
  options.skin.threshold = 0.01f;  // ignores rounding errors in the sides of unmoved triangles
  const BakedMap map =
      toys::BakeFolds(lips, {toys::Pose(toys::Squeeze(0.3f, 0.0f), glm::mat4(1.0f))}, options);
  float first = 0.0f, second = 0.0f;
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      if (!map.covered[toys::At(map, x, y)]) continue;
      float& most = x < map.width / 2 ? first : second;
      most = std::max(most, std::abs(map.height_mm[toys::At(map, x, y)]));
    }
  }
  EXPECT_GT(first, 0.5f);
  EXPECT_EQ(second, 0.0f);
}

TEST(Folds, TooFineForTheSurfaceAreRejected) {
  const character::Character sheet = toys::Wearing(toys::Sheet(2.0f, 2.0f, 10, 10));
  BakeOptions options = toys::Exact();
  options.size = 2048;
  options.skin.wavelength_mm = 1.0f;
  const std::vector<BakePose> poses = {toys::Pose(toys::Squeeze(0.2f, 0.0f))};
  const Status refused = Bake(sheet, poses, {}, options).status();
  EXPECT_EQ(refused.code(), StatusCode::kLimit);
  EXPECT_NE(refused.ToString().find("--skin-wavelength"), std::string::npos);
  EXPECT_NE(refused.ToString().find("--size"), std::string::npos);
}

TEST(CompressionSolver, LimitsItsMemoryOnFineMeshes) {
  const character::Character sheet = toys::Wearing(toys::Sheet(kWidth, kWidth, 60, 60));
  const character::Mesh* meshes[] = {&sheet.meshes[0]};
  const Surface surface(meshes);
  BakeProgress progress({});
  const CompressionSolver solver(surface, 0.02f, &progress);  // about 900 triangles around a vertex
  EXPECT_LE(solver.num_terms(), 64 * surface.positions().size());
  const glm::mat4 squeeze[] = {toys::Squeeze(0.2f, 0.0f), toys::Squeeze(0.2f, 0.0f)};
  for (const Tensor2& tensor : solver.Solve(squeeze, {}, 0.5f).tensors) {
    EXPECT_NEAR(tensor.xx + tensor.yy, 0.2f, 1e-3f);
  }
}

// Counts the valleys along the middle row.
int Valleys(const BakedMap& map) {
  int valleys = 0;
  for (int x = 0; x + 1 < map.width; ++x) {
    valleys += map.derivative[2 * toys::At(map, x, map.height / 2)] > 0.0f &&
               map.derivative[2 * toys::At(map, x + 1, map.height / 2)] <= 0.0f;
  }
  return valleys;
}

TEST(Folds, HaveFineLinesAThirdOfAWavelengthApart) {
  const character::Character sheet = toys::Wearing(toys::Sheet(kWidth, kWidth, 20, 20));
  BakeOptions options = toys::Exact();
  options.size = 512;
  const std::vector<BakePose> poses = {toys::Pose(toys::Squeeze(0.2f, 0.0f))};
  const BakedMap plain = toys::BakeFolds(sheet, poses, options);
  options.skin.fine_lines = 1.0f;
  const BakedMap lined = toys::BakeFolds(sheet, poses, options);
  EXPECT_NEAR(Valleys(plain), 10, 1);
  EXPECT_GT(Valleys(lined), 17);
  EXPECT_NEAR(plain.statistics.finest_mm, 10.0f, 1e-3f);
  EXPECT_NEAR(lined.statistics.finest_mm, 10.0f / 3.0f, 1e-3f);
  EXPECT_NEAR(lined.statistics.coarsest_mm, 10.0f, 1e-3f);
}

TEST(Folds, ReportFoldsWidenedForTheTexels) {
  const character::Character sheet = toys::Wearing(toys::Sheet(kWidth, kWidth, 20, 20));
  BakeOptions options = toys::Exact();  // texels of 0.39 mm
  // Wavelengths of regions that the rig lacks are ignored.
  options.wavelengths = {{"nose", 0.5f}};
  const std::vector<BakePose> poses = {toys::Pose(toys::Squeeze(0.2f, 0.0f))};
  EXPECT_EQ(toys::BakeFolds(sheet, poses, options).statistics.widened_texels, 0);
  options.skin.wavelength_mm = 1.0f;
  const BakedMap::Statistics fine = toys::BakeFolds(sheet, poses, options).statistics;
  EXPECT_EQ(fine.widened_texels, fine.folded_texels);
  EXPECT_NEAR(fine.widened_from_mm, 1.0f, 1e-3f);
  EXPECT_NEAR(fine.widened_to_mm, kTexelsPerWave * 100.0f / 256.0f, 0.01f);
}

}  // namespace
}  // namespace furrow::authoring

// SPDX-License-Identifier: Apache-2.0
//
// Folds on a bent tube, a simple knee.
#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "authoring/paint/surface_texels.h"
#include "tests/unit/authoring/bake/toys.h"

namespace furrow::authoring {
namespace {

using glm::vec3;

constexpr float kRadius = 0.06f;

// A limb along -y with its joint at the origin and its seam at the back. Joint 1 moves the lower
// half. u goes around the limb, v goes up.
character::Mesh Limb() {
  return toys::Grid(40, 40, [](float u, float v) {
    const float angle = 2.0f * 3.14159265f * u;
    const float y = 0.25f * (2.0f * v - 1.0f);
    toys::Point point;
    point.position = {-kRadius * std::sin(angle), y, -kRadius * std::cos(angle)};
    if (u == 1.0f) point.position = {0.0f, y, -kRadius};  // the seam closes exactly
    if (u == 0.0f) point.position = {0.0f, y, -kRadius};
    point.uv = {0.02f + 0.45f * u, 0.98f - 0.9f * v};
    const float t = std::clamp(0.5f - y / 0.12f, 0.0f, 1.0f);
    point.weight_of_second = t * t * (3.0f - 2.0f * t);
    return point;
  });
}

// The leg of a pair of trousers, bent in steps of 10 degrees.
BakedMap BendKnee(const character::Character& limb, float degrees) {
  BakeOptions options;
  options.size = 512;
  const auto bent = [](float angle) {
    return glm::rotate(glm::mat4(1.0f), glm::radians(angle), vec3(1.0f, 0.0f, 0.0f));
  };
  BakePose pose = toys::Pose(glm::mat4(1.0f), bent(degrees));
  for (float angle = 0.0f; angle < degrees; angle += 10.0f) {
    pose.path.push_back({glm::mat4(1.0f), bent(angle)});
  }
  pose.path.push_back(pose.skin_matrices);
  return toys::BakeFolds(limb, {pose}, options);
}

character::Character Trousers() { return toys::Wearing(Limb(), true); }

// The root mean square of the heights of texels that `where` selects, millimetres.
template <class Where>
double Roughness(const character::Character& limb, const BakedMap& map, Where where) {
  double sum = 0.0, count = 0.0;
  for (const SurfaceTexel& t : RasterizeSurface(limb.meshes[0], map.width, map.height)) {
    if (!where(t.position)) continue;
    const double height = double{map.height_mm[toys::At(map, t.x, t.y)]};
    sum += height * height;
    count += 1.0;
  }
  return std::sqrt(sum / std::max(count, 1.0));
}

TEST(Knee, FoldsMostInside) {
  const character::Character limb = Trousers();
  // The turn about +x swings the lower half to the back, so the inside has z < 0.
  const auto inside = [](const vec3& p) { return p.z < -0.5f * kRadius && std::abs(p.y) < 0.06f; };
  const auto outside = [](const vec3& p) { return p.z > 0.5f * kRadius && std::abs(p.y) < 0.06f; };
  for (const float degrees : {50.0f, 90.0f, 130.0f}) {
    const BakedMap map = BendKnee(limb, degrees);
    EXPECT_GT(Roughness(limb, map, inside), 2.0) << degrees;
    EXPECT_GT(Roughness(limb, map, inside), 1.3 * Roughness(limb, map, outside)) << degrees;
    for (const float value : map.height_mm) EXPECT_TRUE(std::abs(value) < 20.0f);
  }
}

TEST(Knee, FoldsDeepenWithTheBend) {
  const character::Character limb = Trousers();
  const auto inside = [](const vec3& p) { return p.z < -0.5f * kRadius && std::abs(p.y) < 0.06f; };
  const double slack = Roughness(limb, BendKnee(limb, 0.0f), inside);
  const double onset = Roughness(limb, BendKnee(limb, 40.0f), inside);
  const double deep = Roughness(limb, BendKnee(limb, 110.0f), inside);
  EXPECT_GT(onset, 1.2 * slack);
  EXPECT_GT(deep, 1.1 * onset);
}

TEST(Knee, FoldsRunAcrossTheLimb) {
  const character::Character limb = Trousers();
  const BakedMap map = BendKnee(limb, 60.0f);
  double along = 0.0, across = 0.0;
  for (const SurfaceTexel& t : RasterizeSurface(limb.meshes[0], 512, 512)) {
    if (t.position.z > -0.7f * kRadius || std::abs(t.position.y) > 0.08f) continue;
    const std::size_t i = toys::At(map, t.x, t.y);
    const vec3 slope = map.derivative[2 * i] * t.tangent + map.derivative[2 * i + 1] * t.bitangent;
    along += static_cast<double>(std::abs(slope.y));
    across += static_cast<double>(std::hypot(slope.x, slope.z));
  }
  EXPECT_GT(along, 1.5 * across);
}

TEST(Knee, SeamAtTheBackIsInvisible) {
  const character::Character limb = Trousers();
  const BakedMap map = BendKnee(limb, 110.0f);
  int first = map.width, last = 0;  // columns of the island
  for (int x = 0; x < map.width; ++x) {
    if (!map.covered[toys::At(map, x, map.height / 2)]) continue;
    first = std::min(first, x);
    last = std::max(last, x);
  }
  const auto jump = [&](int x0, int x1) {
    float most = 0.0f;
    for (int y = 30; y < map.height - 60; ++y) {
      most = std::max(most, std::abs(map.height_mm[toys::At(map, x0, y)] -
                                     map.height_mm[toys::At(map, x1, y)]));
    }
    return most;
  };
  float inside = 0.0f;
  for (int x = first; x < first + 12; ++x) inside = std::max(inside, jump(x, x + 1));
  EXPECT_GT(inside, 0.01f);
  EXPECT_LE(jump(first, last), 2.0f * inside);
}

}  // namespace
}  // namespace furrow::authoring

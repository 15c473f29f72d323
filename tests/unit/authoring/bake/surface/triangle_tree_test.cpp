// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/surface/triangle_tree.h"

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace furrow::authoring {
namespace {

using glm::vec3;

const vec3 kA(0.0f), kB(1.0f, 0.0f, 0.0f), kC(0.0f, 1.0f, 0.0f);

TEST(NearestInTriangle, FindsPointsInsideOnEdgesAndAtCorners) {
  EXPECT_EQ(NearestInTriangle({0.25f, 0.25f, 3.0f}, kA, kB, kC), vec3(0.25f, 0.25f, 0.0f));
  EXPECT_EQ(NearestInTriangle({0.5f, -2.0f, 1.0f}, kA, kB, kC), vec3(0.5f, 0.0f, 0.0f));
  EXPECT_EQ(NearestInTriangle({-1.0f, 0.5f, 1.0f}, kA, kB, kC), vec3(0.0f, 0.5f, 0.0f));
  EXPECT_NEAR(glm::distance(NearestInTriangle({1.0f, 1.0f, 0.0f}, kA, kB, kC), {0.5f, 0.5f, 0.0f}),
              0.0f, 1e-6f);
  EXPECT_EQ(NearestInTriangle({-1.0f, -1.0f, 0.0f}, kA, kB, kC), kA);
  EXPECT_EQ(NearestInTriangle({3.0f, -1.0f, 0.0f}, kA, kB, kC), kB);
  EXPECT_EQ(NearestInTriangle({-1.0f, 3.0f, 0.0f}, kA, kB, kC), kC);
}

TEST(NearestInTriangle, TreatsDegenerateTrianglesAsLinesAndPoints) {
  const vec3 p(0.5f, 1.0f, 0.0f), on_line(0.5f, 0.0f, 0.0f);
  EXPECT_EQ(NearestInTriangle(p, kA, kA, kB), on_line);
  EXPECT_EQ(NearestInTriangle(p, kA, kB, kA), on_line);
  EXPECT_EQ(NearestInTriangle(p, kB, kA, kA), on_line);
  EXPECT_EQ(NearestInTriangle(p, kA, on_line, kB), on_line);  // collinear
  EXPECT_EQ(NearestInTriangle(p, kB, kB, kB), kB);
}

TEST(TriangleTree, AgreesWithExhaustiveSearch) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> place(-1.0f, 1.0f), size(-0.1f, 0.1f);
  const auto any = [&](auto& from) { return vec3(from(random), from(random), from(random)); };
  std::vector<TriangleTree::Corners> triangles;
  std::vector<std::uint32_t> names;
  for (std::uint32_t t = 0; t < 500; ++t) {
    const vec3 at = any(place);
    triangles.push_back({at, at + any(size), t % 7 == 0 ? at : at + any(size)});
    if (t % 5 != 0) names.push_back(t);
  }
  const TriangleTree tree(triangles, names);
  for (int i = 0; i < 200; ++i) {
    const vec3 p = (i % 4 == 0 ? 5.0f : 1.0f) * any(place);
    float nearest = std::numeric_limits<float>::infinity();
    for (const std::uint32_t t : names) {
      const auto& [a, b, c] = triangles[t];
      nearest = std::min(nearest, glm::distance(p, NearestInTriangle(p, a, b, c)));
    }
    const TriangleTree::Nearest found = tree.Find(p);
    EXPECT_NE(found.triangle % 5, 0u);
    EXPECT_NEAR(glm::distance(p, found.position), nearest, 1e-6f);
  }
}

}  // namespace
}  // namespace furrow::authoring

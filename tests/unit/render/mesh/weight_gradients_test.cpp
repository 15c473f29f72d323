// SPDX-License-Identifier: Apache-2.0
#include "render/mesh/weight_gradients.h"

#include <cmath>
#include <functional>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/unit/render/character_parts.h"

namespace furrow::render {
namespace {

using character::Vertex;

// A sheet of 2 m in the plane z = 0 with two joints; `second` gives the weight of joint 7.
character::Mesh Sheet(const std::function<float(const glm::vec3&)>& second) {
  character::Mesh mesh;
  test::AddGrid(
      8, 6,
      [&](float u, float v) {
        Vertex vertex;
        vertex.position = {2.0f * u - 1.0f, 1.0f - 2.0f * v, 0.0f};
        vertex.uv = {u, v};
        vertex.joints[0] = 3;
        vertex.joints[1] = 7;
        vertex.skin_weights[1] = second(vertex.position);
        vertex.skin_weights[0] = 1.0f - vertex.skin_weights[1];
        return vertex;
      },
      &mesh);
  return mesh;
}

float Ramp(const glm::vec3& p) { return 0.5f + 0.2f * p.x - 0.1f * p.y; }

// Of a linear weight, the gradient is the same everywhere, at the border too.
TEST(WeightGradients, AreTheSlopesOfTheWeights) {
  for (const WeightGradient& gradient : WeightGradients(Sheet(Ramp))) {
    EXPECT_NEAR(gradient.along[1], 0.2f, 1e-5f);
    EXPECT_NEAR(gradient.across[1], -0.1f, 1e-5f);
    EXPECT_NEAR(gradient.along[0], -0.2f, 1e-5f);
    EXPECT_NEAR(gradient.across[0], 0.1f, 1e-5f);
    EXPECT_EQ(gradient.along[2], 0.0f);
  }
}

// The axes follow the tangent. A mirrored UV, whose bitangent points the other way, does not count.
TEST(WeightGradients, FollowTheTangent) {
  character::Mesh mesh = Sheet(Ramp);
  // 0.6, 0.8: along the sheet; the part along the normal is left out.
  for (Vertex& vertex : mesh.vertices) vertex.tangent = {0.36f, 0.48f, 0.8f, -1.0f};
  const auto gradients = WeightGradients(mesh);
  ASSERT_EQ(gradients.size(), mesh.vertices.size());
  for (const WeightGradient& gradient : gradients) {
    EXPECT_NEAR(gradient.along[1], 0.6f * 0.2f + 0.8f * -0.1f, 1e-5f);
    EXPECT_NEAR(gradient.across[1], -0.8f * 0.2f + 0.6f * -0.1f, 1e-5f);
  }
}

// A sheet that is bent to a cylinder has the same gradients along its arc.
TEST(WeightGradients, MeasureAlongTheSurface) {
  character::Mesh mesh = Sheet(Ramp);
  const auto flat = WeightGradients(mesh);
  for (Vertex& vertex : mesh.vertices) {
    const float angle = vertex.position.x;  // radius 1 m
    vertex.position = {std::sin(angle), vertex.position.y, std::cos(angle) - 1.0f};
    vertex.normal = {std::sin(angle), 0.0f, std::cos(angle)};
    vertex.tangent = {std::cos(angle), 0.0f, -std::sin(angle), 1.0f};
  }
  const auto bent = WeightGradients(mesh);
  for (std::size_t i = 0; i < flat.size(); ++i) {
    // Edges are chords of 0.25 m: shorter than their arcs by 0.26%.
    EXPECT_NEAR(bent[i].along[1], flat[i].along[1], 2e-3f);
  }
}

// Both sides of a seam see the triangles of the other side.
TEST(WeightGradients, DoNotShowSeams) {
  character::Mesh whole = Sheet([](const glm::vec3& p) { return 0.5f + 0.3f * p.x * p.x; });
  character::Mesh cut = whole;
  for (std::size_t i = 0; i < cut.indices.size() / 2; ++i) {
    Vertex copy = cut.vertices[cut.indices[i]];
    copy.uv.x += 3.0f;
    cut.indices[i] = static_cast<std::uint32_t>(cut.vertices.size());
    cut.vertices.push_back(copy);
  }
  const auto want = WeightGradients(whole);
  const auto got = WeightGradients(cut);
  ASSERT_EQ(got.size(), cut.vertices.size());
  for (std::size_t i = 0; i < whole.indices.size(); ++i) {
    EXPECT_NEAR(got[cut.indices[i]].along[1], want[whole.indices[i]].along[1], 1e-5f);
  }
}

TEST(WeightGradients, OfRigidPartsAreLeftOut) {
  EXPECT_TRUE(WeightGradients(Sheet([](const glm::vec3&) { return 0.4f; })).empty());
  EXPECT_TRUE(WeightGradients(character::Mesh()).empty());
}

}  // namespace
}  // namespace furrow::render

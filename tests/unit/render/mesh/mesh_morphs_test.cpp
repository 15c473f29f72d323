// SPDX-License-Identifier: Apache-2.0
#include "render/mesh/mesh_morphs.h"

#include <algorithm>
#include <array>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace furrow::render {
namespace {

using character::MorphDelta;
using character::MorphTarget;

// A mesh of `num_vertices` with sparse random targets of shapes 0, 2, 4, ...; some runs of vertices
// and some single ones.
character::Mesh RandomTargets(std::size_t num_vertices, int num_targets) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> number(-1.0f, 1.0f);
  const auto vector = [&] { return glm::vec3(number(random), number(random), number(random)); };
  character::Mesh mesh;
  mesh.vertices.resize(num_vertices);
  for (int i = 0; i < num_targets; ++i) {
    MorphTarget target{.shape = 2 * i, .deltas = {}};
    bool is_moved = false;
    // The last eighth of the vertices is not moved by any target.
    for (std::uint32_t vertex = 0; vertex < num_vertices * 7 / 8; ++vertex) {
      if (number(random) > 0.6f) is_moved = !is_moved;
      if (is_moved) target.deltas.push_back({vertex, 0.03f * vector(), vector(), vector()});
    }
    mesh.morph_targets.push_back(target);
  }
  return mesh;
}

std::vector<float> RandomWeights(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> number(-0.5f, 1.0f);
  std::vector<float> weights(count);
  for (float& weight : weights) weight = number(random);
  return weights;
}

std::vector<float> SumOf(const MeshMorphs& morphs, const std::vector<float>& weights) {
  std::vector<float> sums(morphs.num_floats(), 9.0f);
  morphs.Sum(weights, sums);
  return sums;
}

glm::vec3 Part(const std::vector<float>& sums, const MeshMorphs& morphs, std::size_t vertex,
               std::size_t part) {
  const std::size_t first = 3 * (morphs.rows()[vertex] * morphs.num_parts() + part);
  return {sums[first], sums[first + 1], sums[first + 2]};
}

TEST(MeshMorphs, SumsAreThoseOfTheDeltas) {
  const character::Mesh mesh = RandomTargets(400, 9);
  const MeshMorphs morphs(mesh);
  EXPECT_EQ(morphs.num_parts(), 3u);
  const std::vector<float> weights = RandomWeights(18, 3);
  std::vector<std::array<glm::dvec3, 3>> want(mesh.vertices.size());
  for (const MorphTarget& target : mesh.morph_targets) {
    const double weight = weights[static_cast<std::size_t>(target.shape)];
    for (const MorphDelta& delta : target.deltas) {
      want[delta.vertex][0] += weight * glm::dvec3(delta.position);
      want[delta.vertex][1] += weight * glm::dvec3(delta.normal);
      want[delta.vertex][2] += weight * glm::dvec3(delta.tangent);
    }
  }
  const std::vector<float> sums = SumOf(morphs, weights);
  for (std::size_t vertex = 0; vertex < want.size(); ++vertex) {
    for (std::size_t part = 0; part < 3; ++part) {
      EXPECT_LT(glm::distance(glm::dvec3(Part(sums, morphs, vertex, part)), want[vertex][part]),
                1e-6);
    }
  }
}

TEST(MeshMorphs, SumsAreLinear) {
  const MeshMorphs morphs(RandomTargets(400, 9));
  const std::vector<float> one = RandomWeights(18, 3);
  const std::vector<float> other = RandomWeights(18, 4);
  std::vector<float> both(18);
  for (std::size_t i = 0; i < both.size(); ++i) both[i] = one[i] + other[i];
  const std::vector<float> of_one = SumOf(morphs, one);
  const std::vector<float> of_other = SumOf(morphs, other);
  const std::vector<float> of_both = SumOf(morphs, both);
  for (std::size_t i = 0; i < of_both.size(); ++i) {
    EXPECT_NEAR(of_both[i], of_one[i] + of_other[i], 2e-6f) << i;
  }
}

TEST(MeshMorphs, OnlyMovedVerticesHaveRows) {
  const character::Mesh mesh = RandomTargets(400, 2);
  const MeshMorphs morphs(mesh);
  std::vector<bool> is_moved(mesh.vertices.size());
  for (const MorphTarget& target : mesh.morph_targets) {
    for (const MorphDelta& delta : target.deltas) is_moved[delta.vertex] = true;
  }
  std::size_t moved = 0;
  for (std::size_t vertex = 0; vertex < is_moved.size(); ++vertex) {
    EXPECT_EQ(morphs.rows()[vertex] != 0, is_moved[vertex]) << vertex;
    moved += is_moved[vertex] ? 1 : 0;
  }
  EXPECT_EQ(morphs.num_rows(), moved + 1);
  EXPECT_LT(moved, mesh.vertices.size());
  // Vertices that no target moves read row 0.
  const std::vector<float> sums = SumOf(morphs, RandomWeights(4, 1));
  for (std::size_t i = 0; i < 9; ++i) EXPECT_EQ(sums[i], 0.0f);
}

TEST(MeshMorphs, HasThePartsThatSomeTargetHas) {
  character::Mesh mesh;
  mesh.vertices.resize(3);
  mesh.morph_targets = {{.shape = 0, .deltas = {{.vertex = 1, .position = {0, 1, 0}}}},
                        {.shape = 1, .deltas = {{.vertex = 2, .position = {0, 0, 1}}}}};
  EXPECT_EQ(MeshMorphs(mesh).num_parts(), 1u);
  EXPECT_EQ(MeshMorphs(mesh).num_floats(), 9u);
  mesh.morph_targets[1].deltas[0].normal = {0.1f, 0, 0};
  EXPECT_EQ(MeshMorphs(mesh).num_parts(), 2u);
  mesh.morph_targets[0].deltas[0].tangent = {0.1f, 0, 0};
  EXPECT_EQ(MeshMorphs(mesh).num_parts(), 3u);
  mesh.morph_targets.clear();
  EXPECT_TRUE(MeshMorphs(mesh).empty());
  EXPECT_EQ(MeshMorphs(mesh).num_floats(), 0u);
}

TEST(MeshMorphs, InvisibleWeightsAreZeroAndLargeOnesAreLimited) {
  EXPECT_EQ(DrawnShapeWeight(0.9e-4f), 0.0f);
  EXPECT_EQ(DrawnShapeWeight(-0.9e-4f), 0.0f);
  EXPECT_EQ(DrawnShapeWeight(1.1e-4f), 1.1e-4f);
  EXPECT_EQ(DrawnShapeWeight(1.5f), 1.5f);
  EXPECT_EQ(DrawnShapeWeight(1e30f), 2.0f);
  EXPECT_EQ(DrawnShapeWeight(-1e30f), -2.0f);
  const MeshMorphs morphs(RandomTargets(40, 3));
  EXPECT_EQ(SumOf(morphs, {7.0f}), SumOf(morphs, {2.0f}));
  EXPECT_EQ(SumOf(morphs, {5e-5f}), SumOf(morphs, {}));
  EXPECT_FALSE(morphs.Moves(std::vector<float>{5e-5f, 1.0f, 0.0f, 1.0f}));  // 1 and 3: no target
  EXPECT_TRUE(morphs.Moves(std::vector<float>{0.0f, 0.0f, -0.1f}));
}

TEST(MeshMorphs, NoVertexGoesBeyondTheReach) {
  const character::Mesh mesh = RandomTargets(400, 9);
  const MeshMorphs morphs(mesh);
  const std::vector<float> weights = RandomWeights(18, 5);
  const std::vector<float> sums = SumOf(morphs, weights);
  float farthest = 0.0f;
  for (std::size_t vertex = 0; vertex < mesh.vertices.size(); ++vertex) {
    farthest = std::max(farthest, glm::length(Part(sums, morphs, vertex, 0)));
  }
  EXPECT_LE(farthest, morphs.Reach(weights));
  EXPECT_GT(farthest, 0.2f * morphs.Reach(weights));
  EXPECT_EQ(morphs.Reach({}), 0.0f);
}

}  // namespace
}  // namespace furrow::render

// SPDX-License-Identifier: Apache-2.0
#include "render/mesh/mesh_clusters.h"

#include <algorithm>
#include <array>
#include <random>
#include <set>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "tests/unit/render/test_character.h"

namespace furrow::render {
namespace {

// A sheet with a different UV at each vertex, and a morph target that moves every third
// vertex by its number.
character::Character MakeMorphedSheet() {
  character::Character sheet = test::MakeSheet(60, 50);
  character::Mesh& mesh = sheet.meshes[0];
  character::MorphTarget& target = mesh.morph_targets.emplace_back();
  target.shape = 0;
  for (std::uint32_t vertex = 0; vertex < mesh.vertices.size(); vertex += 3) {
    character::MorphDelta& delta = target.deltas.emplace_back();
    delta.vertex = vertex;
    delta.position = mesh.vertices[vertex].position;
  }
  return sheet;
}

using Corner = std::array<float, 2>;

std::multiset<std::array<Corner, 3>> TrianglesOf(const character::Mesh& mesh) {
  std::multiset<std::array<Corner, 3>> triangles;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    std::array<Corner, 3> triangle;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const character::Vertex& vertex = mesh.vertices[mesh.indices[i + corner]];
      triangle[corner] = {vertex.uv.x, vertex.uv.y};
    }
    triangles.insert(triangle);
  }
  return triangles;
}

bool Contains(std::span<const ElementRange> ranges, std::uint32_t element) {
  return std::ranges::any_of(ranges, [&](const ElementRange& range) {
    return element >= range.first && element - range.first < range.count;
  });
}

class MeshClusters : public testing::TestWithParam<Sorting> {
 protected:
  const character::Character sheet_ = MakeMorphedSheet();
  const character::Mesh& before_ = sheet_.meshes[0];
  const ClusteredMesh clustered_ = MakeClusters(before_, sheet_.inverse_bind_matrices, GetParam());
};

TEST_P(MeshClusters, KeepTheTriangles) {
  EXPECT_EQ(TrianglesOf(clustered_.mesh), TrianglesOf(before_));
  EXPECT_EQ(clustered_.mesh.vertices.size(), before_.vertices.size());
}

TEST_P(MeshClusters, MorphTargetsMoveTheSameVertices) {
  const auto& deltas = clustered_.mesh.morph_targets[0].deltas;
  ASSERT_EQ(deltas.size(), before_.morph_targets[0].deltas.size());
  for (const character::MorphDelta& delta : deltas) {
    EXPECT_EQ(delta.position, clustered_.mesh.vertices[delta.vertex].position);
  }
  EXPECT_TRUE(std::ranges::is_sorted(deltas, {}, &character::MorphDelta::vertex));
}

TEST_P(MeshClusters, CoverAllTrianglesOnce) {
  std::uint32_t next = 0;
  for (const MeshCluster& cluster : clustered_.clusters) {
    EXPECT_EQ(cluster.indices.first, next);
    EXPECT_LE(cluster.indices.count, 3 * kMaxClusterTriangles);
    next += cluster.indices.count;
  }
  EXPECT_EQ(next, clustered_.mesh.indices.size());
  EXPECT_GE(clustered_.clusters.size(), before_.indices.size() / (3 * kMaxClusterTriangles));
}

TEST_P(MeshClusters, KnowTheVerticesOfTheirTriangles) {
  for (const MeshCluster& cluster : clustered_.clusters) {
    for (std::uint32_t i = 0; i < cluster.indices.count; ++i) {
      const std::uint32_t vertex = clustered_.mesh.indices[cluster.indices.first + i];
      EXPECT_TRUE(Contains(cluster.vertices, vertex)) << vertex;
    }
  }
}

// A cluster of a sheet of 60 x 50 quads is far smaller than the sheet.
TEST_P(MeshClusters, UseFewVerticesOfOthers) {
  std::size_t sum = 0;
  for (const MeshCluster& cluster : clustered_.clusters) {
    for (const ElementRange& range : cluster.vertices) sum += range.count;
  }
  EXPECT_LT(sum, 3 * before_.vertices.size());
}

TEST_P(MeshClusters, MovesReachAsFarAsTheFarthestVertex) {
  const std::array<float, 1> shapes = {0.5f};
  for (const MeshCluster& cluster : clustered_.clusters) {
    float most = 0.0f;
    const auto indices =
        std::span(clustered_.mesh.indices).subspan(cluster.indices.first, cluster.indices.count);
    for (const character::MorphDelta& delta : clustered_.mesh.morph_targets[0].deltas) {
      if (std::ranges::find(indices, delta.vertex) == indices.end()) continue;
      most = std::max(most, 0.5f * glm::length(delta.position));
    }
    EXPECT_FLOAT_EQ(cluster.MorphReach(shapes), most);
    EXPECT_EQ(cluster.MorphReach({}), 0.0f);
  }
}

// Bounds are in the spaces of joints, which may be in centimetres.
TEST_P(MeshClusters, MovesHaveTheScaleOfTheJoints) {
  std::vector<glm::mat4> binds = sheet_.inverse_bind_matrices;
  for (glm::mat4& bind : binds) bind = glm::scale(bind, glm::vec3(1.0f, 100.0f, 1.0f));
  const ClusteredMesh scaled = MakeClusters(before_, binds, GetParam());
  ASSERT_EQ(scaled.clusters.size(), clustered_.clusters.size());
  const std::array<float, 1> shapes = {1.0f};
  for (std::size_t i = 0; i < scaled.clusters.size(); ++i) {
    EXPECT_NEAR(scaled.clusters[i].MorphReach(shapes),
                100.0f * clustered_.clusters[i].MorphReach(shapes), 1e-2f);
  }
}

TEST_P(MeshClusters, AMeshWithoutTrianglesHasNoneToShow) {
  character::Mesh empty = before_;
  empty.indices.clear();
  for (const MeshCluster& cluster :
       MakeClusters(empty, sheet_.inverse_bind_matrices, GetParam()).clusters) {
    EXPECT_EQ(cluster.indices.count, 0u);
  }
}

TEST_P(MeshClusters, KeepTheOrderUnlessTheySort) {
  const bool is_kept = clustered_.mesh.indices == before_.indices;
  EXPECT_EQ(is_kept, GetParam() == Sorting::kNone);
}

INSTANTIATE_TEST_SUITE_P(Sortings, MeshClusters,
                         testing::Values(Sorting::kByPlace, Sorting::kNone));

// Random ranges of 64 elements, compared with sets.
TEST(ElementRanges, MergeAndDifferLikeSets) {
  std::mt19937 random(7);
  const auto elements = [](std::span<const ElementRange> ranges) {
    std::set<std::uint32_t> set;
    for (const ElementRange& range : ranges) {
      for (std::uint32_t i = 0; i < range.count; ++i) set.insert(range.first + i);
    }
    return set;
  };
  const auto below = [&](std::uint32_t limit) {
    return static_cast<std::uint32_t>(random()) % limit;
  };
  const auto draw = [&] {
    std::vector<ElementRange> ranges(below(6));
    for (ElementRange& range : ranges) range = {below(56), below(8) + 1};
    return ranges;
  };
  for (int run = 0; run < 500; ++run) {
    const std::vector<ElementRange> a = draw();
    const std::vector<ElementRange> b = draw();
    const std::vector<ElementRange> merged = Merged(a);
    EXPECT_EQ(elements(merged), elements(a));
    for (std::size_t i = 1; i < merged.size(); ++i) {
      EXPECT_GT(merged[i].first, merged[i - 1].first + merged[i - 1].count);
    }
    std::set<std::uint32_t> left = elements(a);
    for (const std::uint32_t element : elements(b)) left.erase(element);
    EXPECT_EQ(elements(Difference(merged, Merged(b))), left);
    const std::vector<ElementRange> joined = Merged(a, 4);
    const std::set<std::uint32_t> inner = elements(joined);
    for (const std::uint32_t element : elements(a)) EXPECT_TRUE(inner.contains(element));
  }
}

}  // namespace
}  // namespace furrow::render

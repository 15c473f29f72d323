// SPDX-License-Identifier: Apache-2.0
#include "render/mesh/mesh_clusters.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "render/mesh/mesh_morphs.h"

namespace furrow::render {
namespace {

using Index = std::uint32_t;

// Vertices are posed in blocks. Smaller blocks pose fewer vertices that nobody needs, in more
// ranges.
constexpr Index kBlock = 32;

glm::vec3 Middle(const character::Mesh& mesh, Index triangle) {
  const auto corner = [&](Index i) {
    return mesh.vertices[mesh.indices[3 * triangle + i]].position;
  };
  return (corner(0) + corner(1) + corner(2)) / 3.0f;
}

// Splits triangles at the median of their longest side until each part is small enough, and appends
// the size of each part.
void Split(const std::vector<glm::vec3>& middles, std::span<Index> triangles,
           std::vector<std::size_t>* sizes) {
  if (triangles.size() <= kMaxClusterTriangles) {
    std::ranges::sort(triangles);  // the order of the mesh, which uses vertices one after another
    sizes->push_back(triangles.size());
    return;
  }
  glm::vec3 low(std::numeric_limits<float>::max());
  glm::vec3 high(std::numeric_limits<float>::lowest());
  for (const Index triangle : triangles) {
    low = glm::min(low, middles[triangle]);
    high = glm::max(high, middles[triangle]);
  }
  const glm::vec3 size = high - low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
  const std::size_t half = triangles.size() / 2;
  // Equal places are ordered by number, so that the result does not depend on the algorithm.
  std::ranges::nth_element(triangles, triangles.begin() + static_cast<std::ptrdiff_t>(half),
                           [&](Index a, Index b) {
                             const float at_a = middles[a][axis];
                             const float at_b = middles[b][axis];
                             return at_a != at_b ? at_a < at_b : a < b;
                           });
  Split(middles, triangles.first(half), sizes);
  Split(middles, triangles.subspan(half), sizes);
}

// Renumbers the vertices in the order in which the indices use them first. Vertices that no
// triangle uses come last.
void SortVertices(character::Mesh* mesh) {
  constexpr Index kNone = std::numeric_limits<Index>::max();
  std::vector<Index> number(mesh->vertices.size(), kNone);
  std::vector<character::Vertex> sorted;
  sorted.reserve(mesh->vertices.size());
  const auto place = [&](Index vertex) {
    if (number[vertex] != kNone) return;
    number[vertex] = static_cast<Index>(sorted.size());
    sorted.push_back(mesh->vertices[vertex]);
  };
  for (const Index vertex : mesh->indices) place(vertex);
  for (Index vertex = 0; vertex < number.size(); ++vertex) place(vertex);
  mesh->vertices = std::move(sorted);
  for (Index& vertex : mesh->indices) vertex = number[vertex];
  for (character::MorphTarget& target : mesh->morph_targets) {
    for (character::MorphDelta& delta : target.deltas) delta.vertex = number[delta.vertex];
    std::ranges::sort(target.deltas, {}, &character::MorphDelta::vertex);
  }
}

// How much longer a way in metres is at most in the spaces of the vertex's joints, where bounds
// are.
float ScaleAt(const character::Vertex& vertex, std::span<const glm::mat4> inverse_bind_matrices) {
  float most = 0.0f;
  for (int i = 0; i < 4; ++i) {
    if (!(vertex.skin_weights[i] > 0.0f)) continue;
    const glm::mat3 bind(inverse_bind_matrices[static_cast<std::size_t>(vertex.joints[i])]);
    const glm::mat3 rows = glm::transpose(bind);
    // Scales come before or after the rotation.
    for (int axis = 0; axis < 3; ++axis) {
      most = std::max({most, glm::length(bind[axis]), glm::length(rows[axis])});
    }
  }
  return most;
}

// Fills the moves of all clusters. A vertex may belong to several.
void AddMoves(std::span<const glm::mat4> inverse_bind_matrices, ClusteredMesh* clustered) {
  const character::Mesh& mesh = clustered->mesh;
  if (mesh.morph_targets.empty()) return;
  std::vector<std::vector<std::size_t>> clusters_of(mesh.vertices.size());
  for (std::size_t cluster = 0; cluster < clustered->clusters.size(); ++cluster) {
    const ElementRange& range = clustered->clusters[cluster].indices;
    for (const Index vertex : std::span(mesh.indices).subspan(range.first, range.count)) {
      auto& list = clusters_of[vertex];
      if (list.empty() || list.back() != cluster) list.push_back(cluster);
    }
  }
  for (const character::MorphTarget& target : mesh.morph_targets) {
    std::vector<float> reach(clustered->clusters.size());
    for (const character::MorphDelta& delta : target.deltas) {
      const float way =
          glm::length(delta.position) * ScaleAt(mesh.vertices[delta.vertex], inverse_bind_matrices);
      for (const std::size_t cluster : clusters_of[delta.vertex]) {
        reach[cluster] = std::max(reach[cluster], way);
      }
    }
    for (std::size_t cluster = 0; cluster < reach.size(); ++cluster) {
      if (reach[cluster] == 0.0f) continue;
      clustered->clusters[cluster].moves.push_back(
          {static_cast<std::size_t>(target.shape), reach[cluster]});
    }
  }
}

// Sorts triangles and vertices, and returns the number of triangles of each cluster.
std::vector<std::size_t> SortByPlace(character::Mesh* mesh) {
  std::vector<Index> triangles(mesh->indices.size() / 3);
  std::iota(triangles.begin(), triangles.end(), Index{0});
  std::vector<glm::vec3> middles;
  middles.reserve(triangles.size());
  for (const Index triangle : triangles) middles.push_back(Middle(*mesh, triangle));
  std::vector<std::size_t> sizes;
  Split(middles, triangles, &sizes);

  const std::vector<Index> before = mesh->indices;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    std::copy_n(&before[3 * triangles[i]], 3, &mesh->indices[3 * i]);
  }
  SortVertices(mesh);
  return sizes;
}

std::vector<std::size_t> InOrder(std::size_t num_triangles) {
  std::vector<std::size_t> sizes(num_triangles / kMaxClusterTriangles, kMaxClusterTriangles);
  if (const std::size_t rest = num_triangles % kMaxClusterTriangles; rest > 0) {
    sizes.push_back(rest);
  }
  return sizes;
}

}  // namespace

float MeshCluster::MorphReach(std::span<const float> shapes) const {
  float sum = 0.0f;
  for (const Move& move : moves) {
    if (move.shape < shapes.size()) {
      sum += std::abs(DrawnShapeWeight(shapes[move.shape])) * move.reach;
    }
  }
  return sum;
}

ClusteredMesh MakeClusters(const character::Mesh& mesh,
                           std::span<const glm::mat4> inverse_bind_matrices, Sorting sorting) {
  ClusteredMesh result{mesh, {}};
  const std::vector<std::size_t> sizes =
      sorting == Sorting::kByPlace ? SortByPlace(&result.mesh) : InOrder(mesh.indices.size() / 3);
  std::size_t first = 0;
  for (const std::size_t size : sizes) {
    const auto indices = std::span<const Index>(result.mesh.indices).subspan(3 * first, 3 * size);
    result.clusters.push_back({{static_cast<Index>(3 * first), static_cast<Index>(3 * size)},
                               VertexBlocks(indices, result.mesh.vertices.size()),
                               JointBounds(result.mesh, indices, inverse_bind_matrices),
                               {}});
    first += size;
  }
  AddMoves(inverse_bind_matrices, &result);
  return result;
}

std::vector<ElementRange> VertexBlocks(std::span<const std::uint32_t> indices,
                                       std::size_t num_vertices) {
  std::vector<ElementRange> blocks;
  for (const Index vertex : indices) {
    const Index first = vertex / kBlock * kBlock;
    const auto end = std::min<std::size_t>(first + kBlock, num_vertices);
    if (blocks.empty() || blocks.back().first != first) {
      blocks.push_back({first, static_cast<Index>(end - first)});
    }
  }
  return Merged(std::move(blocks));
}

std::vector<ElementRange> Merged(std::vector<ElementRange> ranges, std::uint32_t gap) {
  std::ranges::sort(ranges, {}, &ElementRange::first);
  std::vector<ElementRange> merged;
  for (const ElementRange& range : ranges) {
    if (!merged.empty()) {
      ElementRange& last = merged.back();
      if (range.first <= last.first + last.count + gap) {
        last.count = std::max(last.first + last.count, range.first + range.count) - last.first;
        continue;
      }
    }
    merged.push_back(range);
  }
  return merged;
}

std::vector<ElementRange> Difference(std::span<const ElementRange> ranges,
                                     std::span<const ElementRange> without) {
  std::vector<ElementRange> left;
  for (const ElementRange& range : ranges) {
    Index from = range.first;
    const Index end = range.first + range.count;
    for (const ElementRange& hole : without) {
      if (hole.first + hole.count <= from || hole.first >= end) continue;
      if (hole.first > from) left.push_back({from, hole.first - from});
      from = hole.first + hole.count;
    }
    if (from < end) left.push_back({from, end - from});
  }
  return left;
}

}  // namespace furrow::render

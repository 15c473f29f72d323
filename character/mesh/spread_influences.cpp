// SPDX-License-Identifier: Apache-2.0
#include "character/mesh/spread_influences.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <tuple>

namespace furrow::character {
namespace {

// The mesh as a graph: triangles connect their corners, and vertices split at a seam are one node.
class VertexGraph {
 public:
  explicit VertexGraph(const Mesh& mesh) : place_(mesh.vertices.size()) {
    JoinPlaces(mesh);
    first_.assign(mesh.vertices.size() + 1, 0);
    // Compressed adjacency lists: count the edges per vertex, sum to offsets, then fill in.
    for (const std::uint32_t index : mesh.indices) first_[place_[index] + 1] += 2;
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    to_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t at = place_[mesh.indices[i + k]];
        to_[next[at]++] = place_[mesh.indices[i + (k + 1) % 3]];
        to_[next[at]++] = place_[mesh.indices[i + (k + 2) % 3]];
      }
    }
  }

  // The vertex that represents all vertices at one position.
  [[nodiscard]] std::uint32_t place(std::size_t vertex) const { return place_[vertex]; }

  template <class Visit>
  void ForNeighbours(std::uint32_t place, Visit visit) const {
    for (std::size_t i = first_[place]; i < first_[place + 1]; ++i) visit(to_[i]);
  }

 private:
  void JoinPlaces(const Mesh& mesh) {
    std::vector<std::uint32_t> order(mesh.vertices.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto key = [&](std::uint32_t v) {
      const glm::vec3& p = mesh.vertices[v].position;
      return std::tuple(p.x, p.y, p.z, v);
    };
    std::sort(order.begin(), order.end(), [&](auto a, auto b) { return key(a) < key(b); });
    for (std::size_t i = 0; i < order.size(); ++i) {
      const bool same =
          i > 0 && mesh.vertices[order[i]].position == mesh.vertices[order[i - 1]].position;
      place_[order[i]] = same ? place_[order[i - 1]] : order[i];
    }
  }

  std::vector<std::uint32_t> place_;
  std::vector<std::size_t> first_;
  std::vector<std::uint32_t> to_;
};

void CopyInfluences(const Vertex& from, Vertex* to) {
  std::copy(std::begin(from.joints), std::end(from.joints), to->joints);
  std::copy(std::begin(from.skin_weights), std::end(from.skin_weights), to->skin_weights);
}

}  // namespace

void SpreadInfluences(std::vector<bool> unskinned, int joint, Mesh* mesh) {
  constexpr std::uint32_t kNone = 0xffffffff;
  const VertexGraph graph(*mesh);
  std::vector<std::uint32_t> source(mesh->vertices.size(),
                                    kNone);  // the representative of each position
  std::vector<std::uint32_t> queue;
  for (std::uint32_t v = 0; v < source.size(); ++v) {
    std::uint32_t& from = source[graph.place(v)];
    if (unskinned[v] || from != kNone) continue;
    from = v;
    queue.push_back(graph.place(v));
  }
  // Breadth first from all skinned vertices at once: each vertex gets the influences of the skinned
  // vertex that is the fewest edges away.
  for (std::size_t i = 0; i < queue.size(); ++i) {
    graph.ForNeighbours(queue[i], [&](std::uint32_t neighbour) {
      if (source[neighbour] != kNone) return;
      source[neighbour] = source[queue[i]];
      queue.push_back(neighbour);
    });
  }
  // For islands without any skinned vertex.
  Vertex alone;
  alone.joints[0] = static_cast<std::uint16_t>(joint);
  for (std::size_t v = 0; v < source.size(); ++v) {
    if (!unskinned[v]) continue;
    const std::uint32_t from = source[graph.place(v)];
    CopyInfluences(from == kNone ? alone : mesh->vertices[from], &mesh->vertices[v]);
  }
}

}  // namespace furrow::character

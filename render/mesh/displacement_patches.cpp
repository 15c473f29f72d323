// SPDX-License-Identifier: Apache-2.0
#include "render/mesh/displacement_patches.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include <glm/geometric.hpp>

#include "character/mesh/weld.h"

namespace furrow::render {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

// The first triangle that contains a welded edge owns it.
struct EdgeOwner {
  Edge vertices;  // the owner's vertices, in the order of the key
  int triangles = 0;
};

// Finds for each edge of the welded mesh the triangle that owns it, and the edges that only one
// triangle has: the border.
class EdgeOwners {
 public:
  EdgeOwners(const character::Mesh& mesh, const std::vector<std::uint32_t>& weld) : weld_(weld) {
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) Add({mesh.indices[i], Next(mesh, i)});
  }
  // The vertex that follows index `i` in its triangle.
  static std::uint32_t Next(const character::Mesh& mesh, std::size_t i) {
    return mesh.indices[i % 3 == 2 ? i - 2 : i + 1];
  }
  // The owner's vertices, in the order of `edge`.
  [[nodiscard]] Edge Owner(const Edge& edge) const {
    const Edge owner = owners_.at(Key(edge)).vertices;
    return weld_[owner.first] == weld_[edge.first] ? owner : Edge{owner.second, owner.first};
  }
  // Welded vertices share the value of the first of them, so that both sides of a UV seam move
  // alike.
  [[nodiscard]] std::vector<float> Shares() const {
    std::vector<bool> is_border(weld_.size());
    for (const auto& [key, owner] : owners_) {
      if (owner.triangles != 1) continue;
      is_border[key.first] = true;
      is_border[key.second] = true;
    }
    std::vector<float> shares;
    for (const std::uint32_t first : weld_) shares.push_back(is_border[first] ? 0.0f : 1.0f);
    return shares;
  }

 private:
  [[nodiscard]] Edge Key(const Edge& edge) const {
    return std::minmax(weld_[edge.first], weld_[edge.second]);
  }
  void Add(const Edge& edge) {
    const auto [found, is_new] = owners_.try_emplace(Key(edge));
    if (is_new) found->second.vertices = edge;
    ++found->second.triangles;
  }

  const std::vector<std::uint32_t>& weld_;
  std::map<Edge, EdgeOwner> owners_;
};

// The cross products are twice the areas on both sides of the quotient. Summed in double, because a
// mesh has very many small triangles.
float MetresPerUv(const character::Mesh& mesh) {
  double surface = 0.0;
  double atlas = 0.0;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const character::Vertex& a = mesh.vertices[mesh.indices[i]];
    const character::Vertex& b = mesh.vertices[mesh.indices[i + 1]];
    const character::Vertex& c = mesh.vertices[mesh.indices[i + 2]];
    surface += glm::length(glm::cross(b.position - a.position, c.position - a.position));
    const glm::vec2 ab = b.uv - a.uv;
    const glm::vec2 ac = c.uv - a.uv;
    atlas += std::abs(ab.x * ac.y - ab.y * ac.x);
  }
  return surface > 0.0 && atlas > 0.0 ? static_cast<float>(std::sqrt(surface / atlas)) : 1.0f;
}

}  // namespace

DisplacementPatches MakeDisplacementPatches(const character::Mesh& mesh) {
  const std::vector<std::uint32_t> weld = character::WeldVertices(mesh);
  const EdgeOwners edges(mesh, weld);
  DisplacementPatches patches;
  patches.indices.reserve(mesh.indices.size() / 3 * DisplacementPatches::kCorners);
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const std::array<std::uint32_t, 3> corners = {mesh.indices[i], mesh.indices[i + 1],
                                                  mesh.indices[i + 2]};
    patches.indices.insert(patches.indices.end(), corners.begin(), corners.end());
    for (int edge = 0; edge < 3; ++edge) {
      const Edge owner = edges.Owner({corners[edge], corners[(edge + 1) % 3]});
      patches.indices.insert(patches.indices.end(), {owner.first, owner.second});
    }
    for (const std::uint32_t corner : corners) patches.indices.push_back(weld[corner]);
  }
  patches.shares = edges.Shares();
  patches.metres_per_uv = MetresPerUv(mesh);
  return patches;
}

}  // namespace furrow::render

// SPDX-License-Identifier: Apache-2.0
#include "character/mesh/weld.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <unordered_map>

namespace furrow::character {
namespace {

// Hashes positions by their bits: both sides of a seam come from one vertex of the artist's mesh.
struct PlaceKey {
  std::uint32_t bits[3];
  bool operator==(const PlaceKey&) const = default;
};

struct PlaceHash {
  std::size_t operator()(const PlaceKey& key) const {
    std::uint64_t hash = 1469598103934665603ull;
    for (const std::uint32_t word : key.bits) hash = (hash ^ word) * 1099511628211ull;
    return static_cast<std::size_t>(hash ^ (hash >> 29));
  }
};

PlaceKey KeyOf(const glm::vec3& position) {
  const glm::vec3 p = position + glm::vec3(0.0f);  // -0 becomes 0
  PlaceKey key;
  std::memcpy(key.bits, &p.x, sizeof key.bits);
  return key;
}

// Summed, because a joint may occur in several of a vertex's four influences.
float WeightOf(const Vertex& vertex, std::uint16_t joint) {
  float sum = 0.0f;
  for (int k = 0; k < 4; ++k) sum += vertex.joints[k] == joint ? vertex.skin_weights[k] : 0.0f;
  return sum;
}

// True if every joint moves both vertices alike.
bool MoveAlike(const Vertex& a, const Vertex& b) {
  constexpr float kTolerance =
      2e-3f;  // skin weights quantised to bytes differ by up to half a step
  for (int k = 0; k < 4; ++k) {
    if (std::abs(WeightOf(a, a.joints[k]) - WeightOf(b, a.joints[k])) > kTolerance) return false;
    if (std::abs(WeightOf(a, b.joints[k]) - WeightOf(b, b.joints[k])) > kTolerance) return false;
  }
  return true;
}

}  // namespace

std::vector<std::uint32_t> WeldVertices(const Mesh& mesh) {
  std::unordered_map<PlaceKey, std::vector<std::uint32_t>, PlaceHash>
      at;  // the first vertices of each point
  std::vector<std::uint32_t> first(mesh.vertices.size());
  for (std::uint32_t i = 0; i < first.size(); ++i) {
    const Vertex& vertex = mesh.vertices[i];
    std::vector<std::uint32_t>& here = at[KeyOf(vertex.position)];
    const auto same = std::find_if(here.begin(), here.end(), [&](std::uint32_t other) {
      return MoveAlike(vertex, mesh.vertices[other]);
    });
    first[i] = same == here.end() ? i : *same;
    if (same == here.end()) here.push_back(i);
  }
  return first;
}

}  // namespace furrow::character

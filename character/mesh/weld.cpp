// SPDX-License-Identifier: Apache-2.0
#include "character/mesh/weld.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <unordered_map>

#include <glm/geometric.hpp>

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

// How the morph targets of a mesh move its vertices.
class Morphs {
 public:
  explicit Morphs(const Mesh& mesh) : starts_(mesh.vertices.size() + 1, 0) {
    for (const MorphTarget& target : mesh.morph_targets) {
      for (const MorphDelta& delta : target.deltas) ++starts_[delta.vertex + 1];
    }
    for (std::size_t i = 1; i < starts_.size(); ++i) starts_[i] += starts_[i - 1];
    moves_.resize(starts_.back());
    std::vector<std::size_t> next(starts_.begin(), starts_.end() - 1);
    // Targets ascend by shape, so each vertex lists its moves by shape.
    for (const MorphTarget& target : mesh.morph_targets) {
      for (const MorphDelta& delta : target.deltas) {
        moves_[next[delta.vertex]++] = {target.shape, delta.position};
      }
    }
  }

  // True if every target moves both vertices alike.
  [[nodiscard]] bool MoveAlike(std::uint32_t a, std::uint32_t b) const {
    std::size_t i = starts_[a], j = starts_[b];
    const std::size_t end_i = starts_[a + 1], end_j = starts_[b + 1];
    while (i < end_i || j < end_j) {
      const bool has_a = i < end_i && (j == end_j || moves_[i].shape <= moves_[j].shape);
      const bool has_b = j < end_j && (i == end_i || moves_[j].shape <= moves_[i].shape);
      const glm::vec3 of_a = has_a ? moves_[i].move : glm::vec3(0.0f);
      const glm::vec3 of_b = has_b ? moves_[j].move : glm::vec3(0.0f);
      i += has_a ? 1 : 0;
      j += has_b ? 1 : 0;
      if (!AreEqual(of_a, of_b)) return false;
    }
    return true;
  }

 private:
  struct Move {
    int shape = 0;
    glm::vec3 move{0.0f};
  };

  // Quantised deltas of the two sides of a seam are equal; those of computed ones differ by
  // rounding.
  static bool AreEqual(const glm::vec3& a, const glm::vec3& b) {
    constexpr float kShare = 1e-3f, kLeast = 2e-6f;  // metres
    const float longer = std::max(glm::length(a), glm::length(b));
    return glm::length(a - b) <= std::max(kShare * longer, kLeast);
  }

  std::vector<std::size_t> starts_;
  std::vector<Move> moves_;
};

}  // namespace

std::vector<std::uint32_t> WeldVertices(const Mesh& mesh) {
  const Morphs morphs(mesh);
  std::unordered_map<PlaceKey, std::vector<std::uint32_t>, PlaceHash>
      at;  // the first vertices of each point
  std::vector<std::uint32_t> first(mesh.vertices.size());
  for (std::uint32_t i = 0; i < first.size(); ++i) {
    const Vertex& vertex = mesh.vertices[i];
    std::vector<std::uint32_t>& here = at[KeyOf(vertex.position)];
    const auto same = std::find_if(here.begin(), here.end(), [&](std::uint32_t other) {
      return MoveAlike(vertex, mesh.vertices[other]) && morphs.MoveAlike(i, other);
    });
    first[i] = same == here.end() ? i : *same;
    if (same == here.end()) here.push_back(i);
  }
  return first;
}

}  // namespace furrow::character

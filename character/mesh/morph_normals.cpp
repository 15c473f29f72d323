// SPDX-License-Identifier: Apache-2.0
#include "character/mesh/morph_normals.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <unordered_map>
#include <utility>

#include <glm/geometric.hpp>

namespace furrow::character {
namespace {

constexpr std::size_t kMaxVisits = std::size_t{1} << 29;  // of triangles, over all targets
constexpr float kLeastDelta = 1e-4f;                      // 0.006 degrees

// The finalizer of SplitMix64.
std::uint64_t Mix(std::uint64_t hash, std::uint64_t word) {
  hash += word + 0x9e3779b97f4a7c15ull;
  hash = (hash ^ (hash >> 30)) * 0xbf58476d1ce4e5b9ull;
  hash = (hash ^ (hash >> 27)) * 0x94d049bb133111ebull;
  return hash ^ (hash >> 31);
}

std::uint64_t Mix(std::uint64_t hash, const glm::vec3& v) {
  const glm::vec3 p = v + glm::vec3(0.0f);  // -0 becomes 0
  for (int i = 0; i < 3; ++i) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &p[i], sizeof bits);
    hash = Mix(hash, bits);
  }
  return hash;
}

glm::dvec3 UnitOrZero(const glm::dvec3& v) {
  const double length = glm::length(v);
  return length > 1e-30 && std::isfinite(length) ? v / length : glm::dvec3(0.0);
}

class NormalMorpher {
 public:
  NormalMorpher(std::size_t max_deltas, Mesh* mesh)
      : mesh_(*mesh),
        max_deltas_(max_deltas),
        offsets_(mesh->vertices.size(), glm::vec3(0.0f)),
        seen_(mesh->indices.size() / 3, 0) {
    for (const MorphTarget& target : mesh_.morph_targets) num_deltas_ += target.deltas.size();
    WeldPoints();
    ListTriangles();
    base_.assign(num_points_, glm::dvec3(0.0));
    for (std::size_t t = 0; t < seen_.size(); ++t) AddArea(t, false, 1.0, &base_);
    change_.assign(num_points_, glm::dvec3(0.0));
  }

  Status Complete(MorphTarget* target) {
    ++stamp_;
    for (const MorphDelta& delta : target->deltas) offsets_[delta.vertex] = delta.position;
    const Status status = SumChanges(*target);
    for (const MorphDelta& delta : target->deltas) offsets_[delta.vertex] = glm::vec3(0.0f);
    FURROW_RETURN_IF_ERROR(status);
    num_deltas_ -= target->deltas.size();
    std::vector<MorphDelta> deltas = TurnedVertices(*target);
    for (const std::uint32_t point : touched_) change_[point] = glm::dvec3(0.0);
    num_deltas_ += deltas.size();
    target->deltas = std::move(deltas);
    if (num_deltas_ <= max_deltas_) return {};
    return {StatusCode::kLimit,
            "the morph targets move too many vertices",
            {},
            "reduce the mesh, or the number of its shapes"};
  }

 private:
  // Numbers the points of the surface: vertices at one position that every target moves alike.
  void WeldPoints() {
    std::vector<std::uint64_t> keys(mesh_.vertices.size());
    for (std::size_t v = 0; v < keys.size(); ++v) keys[v] = Mix(0, mesh_.vertices[v].position);
    for (const MorphTarget& target : mesh_.morph_targets) {
      for (const MorphDelta& delta : target.deltas) {
        std::uint64_t& key = keys[delta.vertex];
        if (delta.position == glm::vec3(0.0f)) continue;
        key = Mix(Mix(key, static_cast<std::uint64_t>(target.shape)), delta.position);
      }
    }
    std::unordered_map<std::uint64_t, std::uint32_t> found;
    for (const std::uint64_t key : keys) {
      point_of_.push_back(
          found.try_emplace(key, static_cast<std::uint32_t>(found.size())).first->second);
    }
    num_points_ = found.size();
    first_vertex_ = Starts(point_of_, num_points_);
    vertices_.resize(point_of_.size());
    std::vector<std::size_t> next(first_vertex_.begin(), first_vertex_.end() - 1);
    for (std::uint32_t v = 0; v < point_of_.size(); ++v) vertices_[next[point_of_[v]]++] = v;
  }

  // The triangles around each vertex.
  void ListTriangles() {
    first_triangle_ = Starts(mesh_.indices, mesh_.vertices.size());
    triangles_.resize(mesh_.indices.size());
    std::vector<std::size_t> next(first_triangle_.begin(), first_triangle_.end() - 1);
    for (std::size_t i = 0; i < mesh_.indices.size(); ++i) {
      triangles_[next[mesh_.indices[i]]++] = static_cast<std::uint32_t>(i / 3);
    }
  }

  // Where the list of each item begins, if `items` are grouped by their value; one more at the end.
  static std::vector<std::size_t> Starts(const std::vector<std::uint32_t>& items,
                                         std::size_t count) {
    std::vector<std::size_t> starts(count + 1, 0);
    for (const std::uint32_t item : items) ++starts[item + 1];
    std::partial_sum(starts.begin(), starts.end(), starts.begin());
    return starts;
  }

  // Adds a triangle's normal, as long as twice its area, to its points. Double precision, so that
  // the difference of two sums is exact enough.
  void AddArea(std::size_t triangle, bool morphed, double factor,
               std::vector<glm::dvec3>* sums) const {
    const std::uint32_t* corner = &mesh_.indices[3 * triangle];
    const auto place = [&](int k) {
      const glm::dvec3 base(mesh_.vertices[corner[k]].position);
      return morphed ? base + glm::dvec3(offsets_[corner[k]]) : base;
    };
    const glm::dvec3 area = glm::cross(place(1) - place(0), place(2) - place(0)) * factor;
    for (int k = 0; k < 3; ++k) (*sums)[point_of_[corner[k]]] += area;
  }

  // Fills change_ and touched_ from the triangles that the target moves. Needs offsets_.
  Status SumChanges(const MorphTarget& target) {
    touched_.clear();
    for (const MorphDelta& delta : target.deltas) {
      if (delta.position == glm::vec3(0.0f)) continue;
      for (std::size_t i = first_triangle_[delta.vertex]; i < first_triangle_[delta.vertex + 1];
           ++i) {
        const std::uint32_t triangle = triangles_[i];
        if (++visits_ > kMaxVisits) {
          return {StatusCode::kLimit,
                  "the morph targets move too many triangles",
                  {},
                  "reduce the mesh, or the number of its shapes"};
        }
        if (seen_[triangle] == stamp_) continue;
        seen_[triangle] = stamp_;
        AddArea(triangle, true, 1.0, &change_);
        AddArea(triangle, false, -1.0, &change_);
        for (std::size_t k = 0; k < 3; ++k) {
          touched_.push_back(point_of_[mesh_.indices[3 * triangle + k]]);
        }
      }
    }
    std::sort(touched_.begin(), touched_.end());
    touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
    return {};
  }

  // The target's deltas with new normals, and those of vertices that only turn.
  std::vector<MorphDelta> TurnedVertices(const MorphTarget& target) const {
    std::vector<MorphDelta> deltas = target.deltas;
    for (MorphDelta& delta : deltas) delta.normal = glm::vec3(0.0f);
    const std::size_t moved = deltas.size();
    for (const std::uint32_t point : touched_) {
      const glm::dvec3 base = UnitOrZero(base_[point]);
      const glm::vec3 turn(UnitOrZero(base_[point] + change_[point]) - base);
      if (!(glm::length(turn) >= kLeastDelta) || base == glm::dvec3(0.0)) continue;
      for (std::size_t i = first_vertex_[point]; i < first_vertex_[point + 1]; ++i) {
        const std::uint32_t vertex = vertices_[i];
        // Stored normals that point against the winding turn the other way.
        const bool inside = glm::dot(mesh_.vertices[vertex].normal, glm::vec3(base)) < 0.0f;
        const auto end = deltas.begin() + static_cast<std::ptrdiff_t>(moved);
        const auto at = std::lower_bound(
            deltas.begin(), end, vertex,
            [](const MorphDelta& delta, std::uint32_t v) { return delta.vertex < v; });
        const glm::vec3 normal = inside ? -turn : turn;
        if (at != end && at->vertex == vertex) {
          at->normal = normal;
        } else {
          deltas.push_back({vertex, glm::vec3(0.0f), normal, glm::vec3(0.0f)});
        }
      }
    }
    std::sort(deltas.begin(), deltas.end(),
              [](const MorphDelta& a, const MorphDelta& b) { return a.vertex < b.vertex; });
    return deltas;
  }

  const Mesh& mesh_;
  const std::size_t max_deltas_;
  std::size_t num_deltas_ = 0;  // of all targets
  std::size_t num_points_ = 0;
  std::vector<std::uint32_t> point_of_;      // per vertex
  std::vector<std::size_t> first_vertex_;    // per point: where its vertices begin in `vertices_`
  std::vector<std::uint32_t> vertices_;      // grouped by point
  std::vector<std::size_t> first_triangle_;  // per vertex, in `triangles_`
  std::vector<std::uint32_t> triangles_;     // grouped by vertex
  std::vector<glm::dvec3> base_;             // per point: the sum of its triangles' normals
  // Of the target at hand:
  std::vector<glm::vec3> offsets_;      // per vertex; zero between targets
  std::vector<glm::dvec3> change_;      // per point: what it adds to base_; zero between targets
  std::vector<std::uint32_t> touched_;  // points with a moved triangle
  std::vector<std::uint32_t> seen_;     // per triangle: the last target that moved it
  std::uint32_t stamp_ = 0;
  std::size_t visits_ = 0;
};

}  // namespace

Status ComputeMorphNormals(const std::vector<bool>& lacking, std::size_t max_deltas, Mesh* mesh) {
  if (std::find(lacking.begin(), lacking.end(), true) == lacking.end()) return {};
  NormalMorpher morpher(max_deltas, mesh);
  for (std::size_t i = 0; i < mesh->morph_targets.size(); ++i) {
    if (lacking[i]) {
      FURROW_RETURN_IF_ERROR(morpher.Complete(&mesh->morph_targets[i]));
    }
  }
  return {};
}

}  // namespace furrow::character

// SPDX-License-Identifier: Apache-2.0
#include "render/mesh/mesh_levels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <queue>
#include <utility>

#include <glm/geometric.hpp>

#include "render/mesh/morph_error.h"

namespace furrow::render {
namespace {

using Index = std::uint32_t;
using Triangle = std::array<Index, 3>;

constexpr std::size_t kMinTriangles = 64;  // a level with fewer triangles saves nothing
constexpr std::size_t kMaxTrianglesPerVertex =
    256;                                    // a vertex with more triangles is kept, with its fan
constexpr double kMaxError = 0.015;         // metres
constexpr double kMinTurnCosine = 0.3;      // smallest cosine between a triangle's normals before
                                            // and after
constexpr double kMinStraightCosine = 0.7;  // smallest cosine between the edges of a straight
                                            // border

glm::dvec3 Cross(const std::array<glm::dvec3, 3>& corners) {
  return glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
}

std::array<Index, 2> EdgeOf(Index a, Index b) { return {std::min(a, b), std::max(a, b)}; }

// A weighted sum of squared distances to planes.
class Quadric {
 public:
  void AddPlane(const glm::dvec3& normal, const glm::dvec3& point, double weight) {
    const double offset = -glm::dot(normal, point);
    const std::array<double, 4> plane = {normal.x, normal.y, normal.z, offset};
    for (int i = 0, next = 0; i < 4; ++i) {
      for (int j = i; j < 4; ++j) terms_[next++] += weight * plane[i] * plane[j];
    }
    weight_ += weight;
  }
  void Add(const Quadric& other) {
    for (std::size_t i = 0; i < terms_.size(); ++i) terms_[i] += other.terms_[i];
    weight_ += other.weight_;
  }
  // Root of the weighted mean squared distance, metres.
  [[nodiscard]] double ErrorAt(const glm::dvec3& point) const {
    const std::array<double, 4> p = {point.x, point.y, point.z, 1.0};
    double sum = 0.0;
    for (int i = 0, next = 0; i < 4; ++i) {
      for (int j = i; j < 4; ++j) sum += (i == j ? 1.0 : 2.0) * terms_[next++] * p[i] * p[j];
    }
    return weight_ > 0.0 ? std::sqrt(std::max(sum, 0.0) / weight_) : 0.0;
  }

 private:
  std::array<double, 10> terms_{};
  double weight_ = 0.0;
};

class Simplifier {
 public:
  Simplifier(const character::Mesh& mesh, Borders borders);

  // Collapses edges until at most `target` triangles are left. False: cannot get there.
  bool Reduce(std::size_t target);
  [[nodiscard]] MeshLevel level() const;
  [[nodiscard]] std::size_t num_triangles() const { return num_alive_; }

 private:
  // The collapse of vertex `from` onto its neighbour `to`.
  struct Collapse {
    double error = 0.0;  // with `drift`
    double drift = 0.0;  // of the morphed surface, metres
    Index from = 0;
    Index to = 0;
    int version = 0;  // of `from`; an older version is outdated
    bool operator>(const Collapse& other) const { return error > other.error; }
  };
  void LockSeams();
  [[nodiscard]] std::vector<std::array<Index, 2>> Edges() const;
  // Returns true if the vertex has too many triangles to examine repeatedly.
  [[nodiscard]] bool IsHub(Index vertex) const {
    return triangles_of_[vertex].size() > kMaxTrianglesPerVertex;
  }
  [[nodiscard]] std::size_t NumTriangles(Index a, Index b) const;
  void HoldBorders();
  [[nodiscard]] std::vector<Index> Neighbours(Index vertex) const;
  [[nodiscard]] bool IsAllowed(Index from, Index to) const;
  [[nodiscard]] std::vector<Triangle> FanWithout(Index from, Index to) const;
  void AddDrift(Collapse* collapse);
  void Propose(Index from);
  void Apply(const Collapse& collapse);

  Borders borders_;
  std::vector<glm::dvec3> positions_;
  std::vector<Triangle> triangles_;
  std::vector<glm::dvec3> facing_;                // per triangle, in the original mesh
  std::vector<bool> is_alive_;                    // per triangle
  std::vector<std::vector<Index>> triangles_of_;  // per vertex, without removed triangles
  std::vector<bool> is_locked_;
  std::vector<bool> is_border_;
  std::vector<int> versions_;
  std::vector<Quadric> quadrics_;
  MorphError morphs_;
  // Per triangle: how far morph targets may take the original surface there from it, metres.
  std::vector<double> drifts_;
  std::priority_queue<Collapse, std::vector<Collapse>, std::greater<>> queue_;
  std::size_t num_alive_ = 0;
  double error_ = 0.0;
};

Simplifier::Simplifier(const character::Mesh& mesh, Borders borders)
    : borders_(borders),
      triangles_of_(mesh.vertices.size()),
      is_locked_(mesh.vertices.size(), false),
      is_border_(mesh.vertices.size(), false),
      versions_(mesh.vertices.size(), 0),
      quadrics_(mesh.vertices.size()),
      morphs_(mesh) {
  for (const character::Vertex& vertex : mesh.vertices) positions_.emplace_back(vertex.position);
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const Triangle triangle = {mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]};
    const glm::dvec3 cross =
        Cross({positions_[triangle[0]], positions_[triangle[1]], positions_[triangle[2]]});
    const double twice_area = glm::length(cross);
    for (const Index corner : triangle) {
      triangles_of_[corner].push_back(static_cast<Index>(triangles_.size()));
      if (twice_area > 0.0) {
        quadrics_[corner].AddPlane(cross / twice_area, positions_[corner], twice_area);
      }
    }
    triangles_.push_back(triangle);
    facing_.push_back(cross);
  }
  num_alive_ = triangles_.size();
  is_alive_.assign(num_alive_, true);
  drifts_.assign(num_alive_, 0.0);
  LockSeams();
  HoldBorders();
  for (Index vertex = 0; vertex < positions_.size(); ++vertex) Propose(vertex);
}

// Locks all vertices that share their position with another one, as at UV and shading seams.
void Simplifier::LockSeams() {
  constexpr double kSamePosition = 1e-6;         // metres
  const glm::dvec3 direction(0.57, 0.61, 0.55);  // meshes rarely have many vertices in a plane
                                                 // across this direction
  // Vertices at exactly the same position become neighbours in the sorted order. The limit bounds
  // the search for nearly equal positions if many vertices lie in one plane.
  constexpr std::ptrdiff_t kMaxCompared = 32;
  struct Along {
    double distance = 0.0;
    std::array<double, 3> position{};
    Index vertex = 0;
    auto operator<=>(const Along&) const = default;
  };
  std::vector<Along> order;
  for (Index vertex = 0; vertex < positions_.size(); ++vertex) {
    const glm::dvec3& position = positions_[vertex];
    order.push_back({glm::dot(direction, position), {position.x, position.y, position.z}, vertex});
  }
  std::ranges::sort(order, [](const Along& a, const Along& b) { return a < b; });
  for (auto one = order.begin(); one != order.end(); ++one) {
    const auto end = one + std::min(kMaxCompared, order.end() - one);
    for (auto other = one + 1; other < end; ++other) {
      if (other->distance - one->distance > kSamePosition) break;
      const Index a = one->vertex;
      const Index b = other->vertex;
      if (glm::distance(positions_[a], positions_[b]) > kSamePosition) continue;
      is_locked_[a] = is_locked_[b] = true;
    }
  }
}

// All edges in sorted order, one entry per triangle that contains the edge.
std::vector<std::array<Index, 2>> Simplifier::Edges() const {
  std::vector<std::array<Index, 2>> edges;
  edges.reserve(3 * triangles_.size());
  for (const Triangle& triangle : triangles_) {
    for (std::size_t i = 0; i < 3; ++i) {
      edges.push_back(EdgeOf(triangle[i], triangle[(i + 1) % 3]));
    }
  }
  std::ranges::sort(edges);
  return edges;
}

// Locks or constrains border vertices. For Borders::kSimplify, a quadric plane perpendicular to the
// surface keeps each border edge on its line. Vertices where a border bends or branches stay.
void Simplifier::HoldBorders() {
  std::vector<std::array<glm::dvec3, 2>> ways(positions_.size());  // the two border edges of each
                                                                   // vertex
  std::vector<std::size_t> num_ways(positions_.size(), 0);
  const std::vector<std::array<Index, 2>> edges = Edges();
  for (const Triangle& triangle : triangles_) {
    const glm::dvec3 cross =
        Cross({positions_[triangle[0]], positions_[triangle[1]], positions_[triangle[2]]});
    for (int i = 0; i < 3; ++i) {
      const Index a = triangle[i];
      const Index b = triangle[(i + 1) % 3];
      const auto [first, last] = std::equal_range(edges.begin(), edges.end(), EdgeOf(a, b));
      const auto count = last - first;
      const bool is_border = count == 1;
      if (count > 2 || (is_border && borders_ == Borders::kKeep)) {
        is_locked_[a] = is_locked_[b] = true;
      }
      if (!is_border || borders_ == Borders::kKeep) continue;
      const glm::dvec3 edge = positions_[b] - positions_[a];
      const glm::dvec3 upright = glm::cross(edge, cross);
      const double length = glm::length(upright);
      for (const Index end : {a, b}) {
        is_border_[end] = true;
        if (num_ways[end] < 2) ways[end][num_ways[end]] = edge;
        ++num_ways[end];
        if (!(length > 0.0)) continue;
        quadrics_[end].AddPlane(upright / length, positions_[end], glm::dot(edge, edge));
      }
    }
  }
  for (Index vertex = 0; vertex < positions_.size(); ++vertex) {
    if (num_ways[vertex] == 0) continue;
    const auto& [first, second] = ways[vertex];
    const bool is_straight =
        glm::dot(first, second) > kMinStraightCosine * glm::length(first) * glm::length(second);
    if (num_ways[vertex] != 2 || !is_straight) is_locked_[vertex] = true;
  }
}

std::size_t Simplifier::NumTriangles(Index a, Index b) const {
  return static_cast<std::size_t>(std::ranges::count_if(triangles_of_[a], [&](Index triangle) {
    return std::ranges::find(triangles_[triangle], b) != triangles_[triangle].end();
  }));
}

std::vector<Index> Simplifier::Neighbours(Index vertex) const {
  std::vector<Index> neighbours;
  for (const Index triangle : triangles_of_[vertex]) {
    for (const Index corner : triangles_[triangle]) {
      if (corner != vertex) neighbours.push_back(corner);
    }
  }
  std::ranges::sort(neighbours);
  neighbours.erase(std::unique(neighbours.begin(), neighbours.end()), neighbours.end());
  return neighbours;
}

// Returns true if the collapse keeps the surface a manifold (it removes two triangles, or one along
// a border) and flips no triangle.
bool Simplifier::IsAllowed(Index from, Index to) const {
  if (IsHub(from) || IsHub(to)) return false;
  const std::vector<Index> of_from = Neighbours(from);
  const std::vector<Index> of_to = Neighbours(to);
  std::vector<Index> common;
  std::ranges::set_intersection(of_from, of_to, std::back_inserter(common));
  if (common.size() != (is_border_[from] ? 1u : 2u)) return false;
  if (std::ranges::any_of(common, [&](Index vertex) { return IsHub(vertex); })) return false;
  if (is_border_[from] && NumTriangles(from, to) != 1) return false;
  return std::ranges::all_of(triangles_of_[from], [&](Index index) {
    const Triangle& triangle = triangles_[index];
    if (std::ranges::find(triangle, to) != triangle.end()) return true;
    std::array<glm::dvec3, 3> before;
    std::array<glm::dvec3, 3> after;
    for (int i = 0; i < 3; ++i) {
      before[i] = positions_[triangle[i]];
      after[i] = positions_[triangle[i] == from ? to : triangle[i]];
    }
    const glm::dvec3 was = Cross(before);
    const glm::dvec3 is = Cross(after);
    // Degenerate triangles, as at the pole of a sphere, have no orientation to preserve.
    const bool is_flat = glm::length(was) <= 1e-12;
    if (glm::dot(facing_[index], is) < 0.0)
      return false;  // also catches a flip by many small
                     // turns
    return is_flat || glm::dot(was, is) > kMinTurnCosine * glm::length(was) * glm::length(is);
  });
}

// The triangles in place of those of `from` once it is collapsed onto `to`.
std::vector<Triangle> Simplifier::FanWithout(Index from, Index to) const {
  std::vector<Triangle> fan;
  for (const Index index : triangles_of_[from]) {
    Triangle triangle = triangles_[index];
    if (std::ranges::find(triangle, to) != triangle.end()) continue;
    std::ranges::replace(triangle, from, to);
    fan.push_back(triangle);
  }
  return fan;
}

// The errors of one collapse after the other add up, because each is measured from the last one.
void Simplifier::AddDrift(Collapse* collapse) {
  if (morphs_.empty()) return;
  std::vector<Triangle> before;
  double drift = 0.0;
  for (const Index index : triangles_of_[collapse->from]) {
    before.push_back(triangles_[index]);
    drift = std::max(drift, drifts_[index]);
  }
  const std::vector<Triangle> after = FanWithout(collapse->from, collapse->to);
  collapse->drift = drift + morphs_.Between(collapse->from, before, after, positions_);
  collapse->error += collapse->drift;
}

void Simplifier::Propose(Index from) {
  if (is_locked_[from] || triangles_of_[from].empty() || IsHub(from)) return;
  std::vector<Collapse> ways;
  for (const Index to : Neighbours(from)) {
    Quadric both = quadrics_[from];
    both.Add(quadrics_[to]);
    const double moved =
        morphs_.empty() ? 0.0 : morphs_.AtVertex(from, FanWithout(from, to), positions_);
    ways.push_back({both.ErrorAt(positions_[to]), moved, from, to, versions_[from]});
  }
  std::ranges::sort(ways, {}, [](const Collapse& way) { return way.error + way.drift; });
  const auto best =
      std::ranges::find_if(ways, [&](const Collapse& way) { return IsAllowed(way.from, way.to); });
  if (best == ways.end()) return;
  AddDrift(&*best);
  queue_.push(*best);
}

void Simplifier::Apply(const Collapse& collapse) {
  const auto [error, drift, from, to, version] = collapse;
  error_ = std::max(error_, error);
  quadrics_[to].Add(quadrics_[from]);
  for (const Index index : triangles_of_[from]) {
    Triangle& triangle = triangles_[index];
    if (std::ranges::find(triangle, to) != triangle.end()) {
      is_alive_[index] = false;
      --num_alive_;
      for (const Index corner : triangle) {
        if (corner != from) std::erase(triangles_of_[corner], index);
      }
    } else {
      std::ranges::replace(triangle, from, to);
      triangles_of_[to].push_back(index);
      drifts_[index] = drift;
    }
  }
  triangles_of_[from].clear();
  std::vector<Index> changed = Neighbours(to);
  changed.push_back(to);
  for (const Index vertex : changed) {
    ++versions_[vertex];
    Propose(vertex);
  }
}

bool Simplifier::Reduce(std::size_t target) {
  while (num_alive_ > target && !queue_.empty() && queue_.top().error < kMaxError) {
    const Collapse collapse = queue_.top();
    queue_.pop();
    if (collapse.version != versions_[collapse.from] || triangles_of_[collapse.from].empty()) {
      continue;
    }
    if (IsAllowed(collapse.from, collapse.to)) {
      Apply(collapse);
    } else {
      ++versions_[collapse.from];
      Propose(collapse.from);
    }
  }
  return num_alive_ <= target;
}

MeshLevel Simplifier::level() const {
  MeshLevel level;
  level.error = static_cast<float>(error_);
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    if (!is_alive_[i]) continue;
    level.indices.insert(level.indices.end(), triangles_[i].begin(), triangles_[i].end());
  }
  return level;
}

}  // namespace

std::vector<MeshLevel> MakeMeshLevels(const character::Mesh& mesh, Borders borders) {
  std::vector<MeshLevel> levels{{mesh.indices, 0.0f}};
  Simplifier simplifier(mesh, borders);
  std::size_t target = simplifier.num_triangles() * 2 / 3;
  while (target >= kMinTriangles && simplifier.Reduce(target)) {
    levels.push_back(simplifier.level());
    target = target * 2 / 3;
  }
  // Adds a last level if the simplifier got stuck after removing at least a fifth of the triangles.
  const std::size_t finest = levels.back().indices.size() / 3;
  if (simplifier.num_triangles() * 5 < finest * 4) levels.push_back(simplifier.level());
  return levels;
}

}  // namespace furrow::render

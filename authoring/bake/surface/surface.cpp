// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/surface/surface.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <glm/geometric.hpp>

#include "authoring/shapes/morph.h"
#include "character/mesh/weld.h"

namespace furrow::authoring {

using glm::vec3;
using wrinkle::SurfaceAxes;

// Any x axis in the plane will do. The helper is never nearly parallel to the normal.
SurfaceAxes AxesAcross(const vec3& normal) {
  const vec3 helper = std::abs(normal.x) < 0.8f ? vec3(1, 0, 0) : vec3(0, 1, 0);
  SurfaceAxes axes;
  axes.normal = normal;
  axes.x = glm::normalize(helper - normal * glm::dot(normal, helper));
  axes.y = glm::cross(normal, axes.x);
  return axes;
}

PlaneRotation Transport(const SurfaceAxes& from, const SurfaceAxes& to) {
  // Applies the shortest rotation from one normal to the other to the x axis.
  const float along = 1.0f + glm::dot(from.normal, to.normal);
  // Opposite normals have no shortest rotation.
  if (along < 1e-4f) return {};
  const vec3 sum = from.normal + to.normal;
  const vec3 x = from.x - sum * (glm::dot(to.normal, from.x) / along);
  const glm::vec2 turned(glm::dot(x, to.x), glm::dot(x, to.y));
  const float length = glm::length(turned);
  if (!(length > 1e-6f)) return {};
  return {turned.x / length, turned.y / length};
}

Tensor2 Carry(const Tensor2& tensor, const PlaneRotation& turn) {
  const float c = turn.cosine, s = turn.sine;
  return {c * c * tensor.xx - 2.0f * c * s * tensor.xy + s * s * tensor.yy,
          c * s * (tensor.xx - tensor.yy) + (c * c - s * s) * tensor.xy,
          s * s * tensor.xx + 2.0f * c * s * tensor.xy + c * c * tensor.yy};
}

Surface::Surface(std::span<const character::Mesh* const> meshes) {
  for (const character::Mesh* mesh : meshes) Append(*mesh);
  Connect();
  MakeAxes();
  MakeTree();
}

// Welds vertices at seams, so that strain and searches cross them. The original vertices stay in
// mesh_ for rasterizing.
void Surface::Append(const character::Mesh& mesh) {
  const auto base = static_cast<std::uint32_t>(mesh_.vertices.size());
  const std::vector<std::uint32_t> first = character::WeldVertices(mesh);
  std::vector<std::uint32_t> welded(mesh.vertices.size());
  for (std::uint32_t i = 0; i < first.size(); ++i) {
    if (first[i] != i) {
      welded[i] = welded[first[i]];
      continue;
    }
    welded[i] = static_cast<std::uint32_t>(positions_.size());
    positions_.push_back(mesh.vertices[i].position);
    source_.push_back(base + i);
  }
  mesh_.vertices.insert(mesh_.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    Triangle triangle;
    for (std::size_t k = 0; k < 3; ++k) {
      triangle.vertices[k] = welded[mesh.indices[i + k]];
      mesh_.indices.push_back(base + mesh.indices[i + k]);
    }
    triangles_.push_back(triangle);
  }
  AppendTargets(mesh, base);
}

// Targets of one shape become one target. Meshes come one after the other, so vertices ascend.
void Surface::AppendTargets(const character::Mesh& mesh, std::uint32_t base) {
  std::vector<character::MorphTarget>& all = mesh_.morph_targets;
  for (const character::MorphTarget& target : mesh.morph_targets) {
    auto place = std::find_if(all.begin(), all.end(),
                              [&](const auto& known) { return known.shape >= target.shape; });
    if (place == all.end() || place->shape != target.shape) {
      place = all.insert(place, {.shape = target.shape, .deltas = {}});
    }
    for (character::MorphDelta delta : target.deltas) {
      delta.vertex += base;
      place->deltas.push_back(delta);
    }
  }
}

std::vector<vec3> Surface::Morphed(std::span<const float> shape_weights) const {
  const std::vector<vec3> moved = MorphedPositions(mesh_, shape_weights);
  std::vector<vec3> positions;
  positions.reserve(source_.size());
  for (const std::uint32_t vertex : source_) positions.push_back(moved[vertex]);
  return positions;
}

// Pairs triangles by their welded edges. A third triangle on an edge stays unpaired, so
// non-manifold input still has at most one neighbour per edge. The fans list the triangles around
// each vertex.
void Surface::Connect() {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<std::uint32_t, int>> open;
  fan_starts_.assign(positions_.size() + 1, 0);
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = triangles_[t].vertices[static_cast<std::size_t>(k)];
      const std::uint32_t b = triangles_[t].vertices[static_cast<std::size_t>((k + 1) % 3)];
      ++fan_starts_[a + 1];
      const auto [place, fresh] = open.try_emplace(std::minmax(a, b), t, k);
      if (fresh) continue;
      const auto [other, edge] = place->second;
      triangles_[t].neighbours[static_cast<std::size_t>(k)] = other;
      triangles_[other].neighbours[static_cast<std::size_t>(edge)] = t;
      open.erase(place);
    }
  }
  for (std::size_t i = 1; i < fan_starts_.size(); ++i) fan_starts_[i] += fan_starts_[i - 1];
  fans_.resize(fan_starts_.back());
  std::vector<std::size_t> next(fan_starts_.begin(), fan_starts_.end() - 1);
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    for (const std::uint32_t vertex : triangles_[t].vertices) fans_[next[vertex]++] = t;
  }
}

// Vertex normals are weighted by area, since the cross product's length is the area.
void Surface::MakeAxes() {
  std::vector<vec3> normals(positions_.size(), vec3(0.0f));
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    Triangle& triangle = triangles_[t];
    const auto [a, b, c] = Corners(t);
    const vec3 area = 0.5f * glm::cross(b - a, c - a);
    triangle.area = glm::length(area);
    triangle.strain = wrinkle::MakeRestTriangle(a, b, c, b - a);
    const bool usable = triangle.area > 1e-20f;
    triangle.axes = triangle.strain ? triangle.strain->axes
                                    : AxesAcross(usable ? area / triangle.area : vec3(0, 0, 1));
    for (const std::uint32_t vertex : triangle.vertices) normals[vertex] += area;
  }
  axes_.reserve(positions_.size());
  for (const vec3& normal : normals) {
    const float length = glm::length(normal);
    axes_.push_back(AxesAcross(length > 1e-20f ? normal / length : vec3(0, 0, 1)));
  }
}

// Uses only triangles with an area, or all triangles if none has one.
void Surface::MakeTree() {
  std::vector<TriangleTree::Corners> corners;
  std::vector<std::uint32_t> whole, all;
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    corners.push_back(Corners(t));
    all.push_back(t);
    if (triangles_[t].strain) whole.push_back(t);
  }
  tree_.emplace(corners, whole.empty() ? std::move(all) : std::move(whole));
}

std::array<vec3, 3> Surface::Corners(std::uint32_t triangle) const {
  const auto& v = triangles_[triangle].vertices;
  return {positions_[v[0]], positions_[v[1]], positions_[v[2]]};
}

SurfacePoint Surface::PointOf(std::uint32_t triangle, const vec3& corners) const {
  const auto [a, b, c] = Corners(triangle);
  return {triangle, corners, corners.x * a + corners.y * b + corners.z * c};
}

SurfacePoint Surface::Nearest(const vec3& p) const {
  const TriangleTree::Nearest nearest = tree_->Find(p);
  SurfacePoint best{nearest.triangle, vec3(0.0f), nearest.position};
  const auto [a, b, c] = Corners(best.triangle);
  const vec3 normal = glm::cross(b - a, c - a);
  const float square = std::max(glm::dot(normal, normal), 1e-30f);
  // Barycentric coordinates as ratios of areas. The guard is for degenerate triangles.
  best.corners.x = glm::dot(glm::cross(c - b, best.position - b), normal) / square;
  best.corners.y = glm::dot(glm::cross(a - c, best.position - c), normal) / square;
  best.corners.z = 1.0f - best.corners.x - best.corners.y;
  return best;
}

Tensor2 Surface::Interpolate(std::span<const Tensor2> tensors, const SurfacePoint& point) const {
  const Triangle& triangle = triangles_[point.triangle];
  Tensor2 sum;
  for (int k = 0; k < 3; ++k) {
    const std::uint32_t v = triangle.vertices[static_cast<std::size_t>(k)];
    sum = sum + point.corners[k] * Carry(tensors[v], Transport(axes_[v], triangle.axes));
  }
  return sum;
}

SurfaceSearch::SurfaceSearch(const Surface& surface)
    : surface_(surface), stamps_(surface.triangles().size(), 0) {}

// Dijkstra's algorithm over triangles. Stamps mark visited triangles without clearing an array for
// each search. Ties go to the lower index, so that results are repeatable.
std::span<const std::uint32_t> SurfaceSearch::Find(const vec3& centre,
                                                   std::span<const std::uint32_t> seeds,
                                                   float radius) {
  // Paths lead from edge to edge through the nearest points, so they are a little longer than the
  // shortest path.
  constexpr float kDetour = 1.4f;
  ++stamp_;
  heap_.clear();
  found_.clear();
  const auto later = [](const Entry& a, const Entry& b) {
    return a.length != b.length ? a.length > b.length : a.triangle > b.triangle;
  };
  for (const std::uint32_t seed : seeds) heap_.push_back({0.0f, seed, centre});
  while (!heap_.empty()) {
    std::pop_heap(heap_.begin(), heap_.end(), later);
    const Entry entry = heap_.back();
    heap_.pop_back();
    if (stamps_[entry.triangle] == stamp_) continue;
    stamps_[entry.triangle] = stamp_;
    found_.push_back(entry.triangle);
    const auto corners = surface_.Corners(entry.triangle);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t next = surface_.triangles()[entry.triangle].neighbours[k];
      if (next == kNoTriangle || stamps_[next] == stamp_) continue;
      const vec3 a = corners[k], b = corners[(k + 1) % 3];
      // The edge must be within reach. The path crosses it at the point nearest to the centre,
      // which keeps paths on a flat surface straight.
      const vec3 gate = NearestOnEdge(centre, a, b);
      if (glm::distance(gate, centre) >= radius) continue;
      const float length = entry.length + glm::distance(gate, entry.point);
      if (length > kDetour * radius) continue;
      heap_.push_back({length, next, gate});
      std::push_heap(heap_.begin(), heap_.end(), later);
    }
  }
  return found_;
}

}  // namespace furrow::authoring

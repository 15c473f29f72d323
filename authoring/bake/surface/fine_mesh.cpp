// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/surface/fine_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

namespace furrow::authoring {
namespace {

using glm::vec3;

std::uint64_t KeyOf(std::uint32_t a, std::uint32_t b) {
  return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
}

// Twice the signed area of a triangle of barycentric coordinates, relative to the whole.
float AreaOf(const vec3& a, const vec3& b, const vec3& c) {
  return (b.y - a.y) * (c.z - a.z) - (b.z - a.z) * (c.y - a.y);
}

// The cell of a grid with `side` cells over [0, 1].
std::uint32_t CellOf(float coordinate, std::uint32_t side) {
  const float cell = std::clamp(coordinate, 0.0f, 1.0f) * static_cast<float>(side);
  return std::min(static_cast<std::uint32_t>(cell), side - 1);
}

// A triangle some of whose edges are halved. Corners are 0 to 2; k + 3 is the middle of the edge
// that begins at corner k.
struct HalvedTriangle {
  FineMesh::Triangle whole;
  // Per edge: the vertex in its middle.
  std::array<std::uint32_t, 3> half{kNoTriangle, kNoTriangle, kNoTriangle};

  [[nodiscard]] std::uint32_t vertex(std::size_t k) const {
    return k < 3 ? whole.vertices[k] : half[k - 3];
  }
  [[nodiscard]] vec3 place(std::size_t k) const {
    return k < 3 ? whole.places[k] : 0.5f * (whole.places[k - 3] + whole.places[(k - 2) % 3]);
  }
  [[nodiscard]] bool is_halved(std::size_t k) const { return half[k % 3] != kNoTriangle; }

  // Adds its 1 to 4 parts. `positions`: of the vertices.
  void AddParts(std::span<const vec3> positions, std::vector<FineMesh::Triangle>* parts) const {
    const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
      parts->push_back({.vertices = {vertex(a), vertex(b), vertex(c)},
                        .places = {place(a), place(b), place(c)}});
    };
    switch (std::ranges::count_if(half, [](std::uint32_t v) { return v != kNoTriangle; })) {
      case 0: add(0, 1, 2); break;
      case 1: {
        const std::size_t k = is_halved(0) ? 0 : is_halved(1) ? 1 : 2;
        add(k, k + 3, (k + 2) % 3);
        add(k + 3, (k + 1) % 3, (k + 2) % 3);
        break;
      }
      case 2: {
        const std::size_t a = !is_halved(2) ? 0 : !is_halved(0) ? 1 : 2;  // a and a + 1 are halved
        const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
        add(a + 3, b, b + 3);
        // The rest is a quad; its shorter diagonal splits it.
        const float first = glm::distance(positions[vertex(a)], positions[vertex(b + 3)]);
        const float second = glm::distance(positions[vertex(a + 3)], positions[vertex(c)]);
        if (first < second) {
          add(a, a + 3, b + 3);
          add(a, b + 3, c);
        } else {
          add(a, a + 3, c);
          add(a + 3, b + 3, c);
        }
        break;
      }
      default:
        add(0, 3, 5);
        add(3, 1, 4);
        add(5, 4, 2);
        add(3, 4, 5);
    }
  }
};

}  // namespace

FineMesh::FineMesh(const Surface& surface, float edge) : surface_(surface), edge_(edge) {
  positions_.assign(surface.positions().begin(), surface.positions().end());
  for (std::uint32_t v = 0; v < positions_.size(); ++v) {
    vertices_.push_back({.corners = {v, v, v}, .shares = vec3(1.0f, 0.0f, 0.0f)});
  }
  for (std::uint32_t t = 0; t < surface.triangles().size(); ++t) {
    triangles_.push_back({.vertices = surface.triangles()[t].vertices,
                          .places = {vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1)}});
    bases_.push_back(t);
  }
  Split(4.0f / 3.0f * edge);
  Connect();
  MakeGrids();
}

void FineMesh::Split(float longest) {
  constexpr int kMaxPasses = 8;                    // an edge of 2 m becomes 8 mm
  constexpr std::size_t kMostTriangles = 400'000;  // a pass makes at most four times as many
  for (int pass = 0; pass < kMaxPasses && triangles_.size() <= kMostTriangles; ++pass) {
    if (!SplitOnce(longest)) break;
  }
  starts_.assign(surface_.triangles().size() + 1, triangles_.size());
  for (std::size_t t = triangles_.size(); t-- > 0;) starts_[bases_[t]] = t;
}

// Halves every edge that is too long. A triangle becomes 1 to 4, depending on how many of its edges
// are halved, and its parts stay where it was in the list.
bool FineMesh::SplitOnce(float longest) {
  std::unordered_map<std::uint64_t, std::uint32_t> halves;
  const auto half_of = [&](const Triangle& triangle, std::uint32_t base, std::size_t k) {
    const std::uint32_t a = triangle.vertices[k], b = triangle.vertices[(k + 1) % 3];
    if (a == b || glm::distance(positions_[a], positions_[b]) <= longest) return kNoTriangle;
    const auto [place, fresh] =
        halves.try_emplace(KeyOf(a, b), static_cast<std::uint32_t>(vertices_.size()));
    if (fresh) {
      vertices_.push_back({.corners = surface_.triangles()[base].vertices,
                           .shares = 0.5f * (triangle.places[k] + triangle.places[(k + 1) % 3])});
      positions_.push_back(0.5f * (positions_[a] + positions_[b]));
    }
    return place->second;
  };
  std::vector<Triangle> parts;
  std::vector<std::uint32_t> bases;
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    HalvedTriangle triangle{triangles_[t]};
    const bool has_area = surface_.triangles()[bases_[t]].strain.has_value();
    for (std::size_t k = 0; k < 3 && has_area; ++k) {
      triangle.half[k] = half_of(triangle.whole, bases_[t], k);
    }
    triangle.AddParts(positions_, &parts);
    bases.resize(parts.size(), bases_[t]);
  }
  const bool split = parts.size() > triangles_.size();
  triangles_ = std::move(parts);
  bases_ = std::move(bases);
  return split;
}

void FineMesh::Connect() {
  std::vector<std::uint64_t> keys;
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    // Its long edges would span many short ones.
    if (!surface_.triangles()[bases_[t]].strain) continue;
    const Triangle& triangle = triangles_[t];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = triangle.vertices[k], b = triangle.vertices[(k + 1) % 3];
      if (a != b) keys.push_back(KeyOf(a, b));
    }
  }
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  fan_starts_.assign(vertices_.size() + 1, 0);
  for (const std::uint64_t key : keys) {
    const Edge edge{static_cast<std::uint32_t>(key >> 32), static_cast<std::uint32_t>(key)};
    edges_.push_back(edge);
    ++fan_starts_[edge[0] + 1];
    ++fan_starts_[edge[1] + 1];
  }
  for (std::size_t i = 1; i < fan_starts_.size(); ++i) fan_starts_[i] += fan_starts_[i - 1];
  fans_.resize(fan_starts_.back());
  std::vector<std::size_t> next(fan_starts_.begin(), fan_starts_.end() - 1);
  for (const Edge& edge : edges_) {
    fans_[next[edge[0]]++] = edge[1];
    fans_[next[edge[1]]++] = edge[0];
  }
}

void FineMesh::MakeGrids() {
  constexpr std::size_t kFewParts = 16;
  std::vector<std::vector<std::uint32_t>> cells;
  for (std::size_t base = 0; base + 1 < starts_.size(); ++base) {
    const std::size_t first = starts_[base], last = starts_[base + 1];
    Grid& grid = grids_.emplace_back();
    if (last - first <= kFewParts) continue;
    grid.side = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(last - first)));
    grid.first_cell = cells.size();
    cells.resize(cells.size() + std::size_t{grid.side} * grid.side);
    for (std::size_t t = first; t < last; ++t) {
      const auto& [a, b, c] = triangles_[t].places;
      const vec3 low = glm::min(a, glm::min(b, c)), high = glm::max(a, glm::max(b, c));
      for (std::uint32_t y = CellOf(low.y, grid.side); y <= CellOf(high.y, grid.side); ++y) {
        for (std::uint32_t x = CellOf(low.x, grid.side); x <= CellOf(high.x, grid.side); ++x) {
          cells[grid.first_cell + std::size_t{y} * grid.side + x].push_back(
              static_cast<std::uint32_t>(t));
        }
      }
    }
  }
  for (const std::vector<std::uint32_t>& cell : cells) {
    cell_starts_.push_back(cell_parts_.size());
    cell_parts_.insert(cell_parts_.end(), cell.begin(), cell.end());
  }
  cell_starts_.push_back(cell_parts_.size());
}

// The part that holds the point; rounding may put a point on a border slightly outside of all.
FineMesh::Place FineMesh::Find(const SurfacePoint& point) const {
  Place best{static_cast<std::uint32_t>(starts_[point.triangle]), vec3(1.0f / 3.0f)};
  float least = -1e9f;
  const auto holds = [&](std::uint32_t t) {
    const auto& [a, b, c] = triangles_[t].places;
    const float area = AreaOf(a, b, c);
    const vec3 corners = vec3(AreaOf(point.corners, b, c), AreaOf(a, point.corners, c),
                              AreaOf(a, b, point.corners)) /
                         area;
    const float inside = std::min({corners.x, corners.y, corners.z});
    if (inside <= least) return false;
    least = inside;
    best = {t, corners};
    return inside >= 0.0f;
  };
  const Grid& grid = grids_[point.triangle];
  if (grid.side == 0) {
    for (std::size_t t = starts_[point.triangle]; t < starts_[point.triangle + 1]; ++t) {
      if (holds(static_cast<std::uint32_t>(t))) break;
    }
    return best;
  }
  const std::size_t cell = grid.first_cell +
                           std::size_t{CellOf(point.corners.y, grid.side)} * grid.side +
                           CellOf(point.corners.x, grid.side);
  for (std::size_t i = cell_starts_[cell]; i < cell_starts_[cell + 1]; ++i) {
    if (holds(cell_parts_[i])) break;
  }
  return best;
}

}  // namespace furrow::authoring

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "authoring/bake/surface/surface.h"

namespace furrow::authoring {

// A surface whose triangles are split until they are small enough to fold. It lies on the surface
// and keeps the surface's shape. Neighbouring triangles are split alike, so there are no gaps.
class FineMesh {
 public:
  // A vertex inside a triangle of the surface or on its border.
  struct Vertex {
    std::array<std::uint32_t, 3> corners{};  // welded vertices of the surface
    glm::vec3 shares{1.0f, 0.0f, 0.0f};      // barycentric coordinates; they sum to 1
    template <class T>
    [[nodiscard]] T Interpolate(std::span<const T> values) const {
      return values[corners[0]] * shares.x + values[corners[1]] * shares.y +
             values[corners[2]] * shares.z;
    }
  };
  struct Triangle {
    std::array<std::uint32_t, 3> vertices{};
    // The corners in the triangle of the surface that this one is part of, barycentric.
    std::array<glm::vec3, 3> places{};
  };
  using Edge = std::array<std::uint32_t, 2>;
  // Where a point of the surface lies.
  struct Place {
    std::uint32_t triangle = 0;
    glm::vec3 corners{0.0f};  // barycentric; they sum to 1
  };

  // Edges longer than 4/3 `edge` (metres, > 0) are halved, but not those of triangles without area.
  // At 1.6 million triangles, halving stops. `surface` must outlive the mesh.
  FineMesh(const Surface& surface, float edge);

  // As given.
  [[nodiscard]] float edge() const { return edge_; }

  [[nodiscard]] const Surface& surface() const { return surface_; }
  [[nodiscard]] std::span<const Vertex> vertices() const { return vertices_; }
  [[nodiscard]] std::span<const Triangle> triangles() const { return triangles_; }
  [[nodiscard]] std::span<const Edge> edges() const { return edges_; }
  // The positions at rest, metres.
  [[nodiscard]] std::span<const glm::vec3> positions() const { return positions_; }
  // The vertices that share an edge with a vertex.
  [[nodiscard]] std::span<const std::uint32_t> Around(std::size_t vertex) const {
    return std::span(fans_).subspan(fan_starts_[vertex],
                                    fan_starts_[vertex + 1] - fan_starts_[vertex]);
  }
  [[nodiscard]] Place Find(const SurfacePoint& point) const;

 private:
  void Split(float longest);
  bool SplitOnce(float longest);
  void Connect();

  void MakeGrids();

  // The parts of a triangle of the surface that touch each cell of a grid over its first two
  // barycentric coordinates. Cells of row y and column x are y * side + x from `first_cell` on.
  struct Grid {
    std::uint32_t side = 0;  // 0: too few parts for a grid
    std::size_t first_cell = 0;
  };

  const Surface& surface_;
  float edge_;
  std::vector<Vertex> vertices_;
  std::vector<glm::vec3> positions_;
  std::vector<Triangle> triangles_;   // those of one triangle of the surface are consecutive
  std::vector<std::uint32_t> bases_;  // per triangle: the triangle of the surface
  std::vector<std::size_t> starts_;   // per triangle of the surface: its first, and the end
  std::vector<Edge> edges_;
  std::vector<std::uint32_t> fans_;
  std::vector<std::size_t> fan_starts_;
  std::vector<Grid> grids_;               // per triangle of the surface
  std::vector<std::size_t> cell_starts_;  // per cell, and the end: into cell_parts_
  std::vector<std::uint32_t> cell_parts_;
};

}  // namespace furrow::authoring

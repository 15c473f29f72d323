// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "authoring/generator/mesh/solid.h"
#include "authoring/skinning/influences.h"
#include "character/character.h"

namespace furrow::authoring {

// A surface of quads under construction. Points are places on the surface, each once; panels, the
// pieces of cloth that are unrolled one by one, meet at points and have corners of their own there.
struct QuadNet {
  struct Point {
    glm::vec3 place{0.0f};
    float slack = 0.0f;  // [0, 1]: how freely Relax() may move it
    Influences skin;
  };
  struct Corner {
    int point = 0;
    int panel = 0;
    glm::vec2 uv{0.0f};  // metres in the panel, v down, until the panels are placed in an atlas
  };
  std::vector<Point> points;
  std::vector<Corner> corners;
  std::vector<std::array<int, 4>> quads;  // of corners, counter-clockwise from outside

  int AddPoint(const glm::vec3& place, float slack = 0.0f);
};

// A grid of points, row by row.
struct PointGrid {
  int rows = 0;
  int columns = 0;
  std::vector<int> points;

  PointGrid(int rows_, int columns_)
      : rows(rows_), columns(columns_), points(static_cast<std::size_t>(rows_) * columns_, -1) {}
  [[nodiscard]] int& At(int row, int column) { return points[row * columns + column]; }
  [[nodiscard]] int At(int row, int column) const { return points[row * columns + column]; }
};

// Lays quads over the cells of a grid as part of `panel`; `skip` (may be empty) leaves cells out by
// their low row and column. To a viewer outside rows run upward and columns to the right, or to the
// left where `mirrored`. The corners' first uv is their place in the grid by mean lengths of edges.
void AddPatch(const PointGrid& grid, int panel, bool mirrored,
              const std::function<bool(int, int)>& skip, QuadNet* net);

// Evens out the points that have slack over their neighbours, on the surface of `solid`.
void Relax(const Solid& solid, int rounds, QuadNet* net);

// Four quads of each, the new points on the surface of `solid`; influences and uv are means.
void Subdivide(const Solid& solid, QuadNet* net);

// Means of the influences of neighbours, `rounds` times; the strongest four are kept.
void SmoothInfluences(int rounds, QuadNet* net);

// Appends a net to another one; they share nothing.
void Join(const QuadNet& from, QuadNet* to);

// Appends the net to a mesh, a vertex for each corner; normals and tangents are not made.
void AppendNet(const QuadNet& net, character::Mesh* mesh);

// The neighbours of every point along the edges of quads, each once, ascending.
[[nodiscard]] std::vector<std::vector<int>> Neighbours(const QuadNet& net);

}  // namespace furrow::authoring

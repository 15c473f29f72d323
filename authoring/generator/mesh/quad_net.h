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

// A surface of quads under construction. A panel is a piece of the surface with a separate UV
// island, such as one piece of cloth. Where panels meet they share points, but each panel has
// separate corners there, so that UVs may differ.
struct QuadNet {
  struct Point {
    glm::vec3 place{0.0f};  // metres
    float slack = 0.0f;     // how far Relax() moves the point, 0 (fixed) to 1 (free)
    Influences skin;
  };
  struct Corner {
    int point = 0;
    int panel = 0;
    glm::vec2 uv{0.0f};  // metres in the panel, v down; atlas coordinates after PackPanels()
  };
  std::vector<Point> points;
  std::vector<Corner> corners;
  std::vector<std::array<int, 4>> quads;  // indices of corners, counter-clockwise from outside

  // Appends a point without influences and returns its index.
  int AddPoint(const glm::vec3& place, float slack = 0.0f);
};

// A grid of indices of points, row by row; -1 where no point is set yet.
struct PointGrid {
  int rows = 0;
  int columns = 0;
  std::vector<int> points;

  PointGrid(int rows_, int columns_)
      : rows(rows_), columns(columns_), points(static_cast<std::size_t>(rows_) * columns_, -1) {}
  [[nodiscard]] int& At(int row, int column) { return points[row * columns + column]; }
  [[nodiscard]] int At(int row, int column) const { return points[row * columns + column]; }
};

// Adds one quad per cell of a grid to panel `panel`. `skip(row, column)` (optional) returns true to
// leave out the cell with that low corner. Seen from outside, rows run upward and columns to the
// right, or to the left if `mirrored`. UVs of the corners are their grid positions, scaled by mean
// edge lengths to metres; FlattenPanels() improves them.
void AddPatch(const PointGrid& grid, int panel, bool mirrored,
              const std::function<bool(int, int)>& skip, QuadNet* net);

// Moves points with slack toward the mean of their neighbours, on the surface of `solid`, `rounds`
// times (half of the way per round at slack 1).
void Relax(const Solid& solid, int rounds, QuadNet* net);

// Splits each quad into four. New points lie on the surface of `solid`; their influences and UVs
// are means.
void Subdivide(const Solid& solid, QuadNet* net);

// Averages each point's influences with those of its neighbours, `rounds` times. Keeps the
// strongest four.
void SmoothInfluences(int rounds, QuadNet* net);

// Appends all points, corners and quads of `from` to `to`. Points are not merged.
void Join(const QuadNet& from, QuadNet* to);

// Appends the net to a mesh as triangles with one vertex per corner. Does not set normals and
// tangents.
void AppendNet(const QuadNet& net, character::Mesh* mesh);

// The neighbours of each point along the edges of quads, without repetition, in ascending order.
[[nodiscard]] std::vector<std::vector<int>> Neighbours(const QuadNet& net);

}  // namespace furrow::authoring

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

// A surface of quads under construction. Each point is a position on the surface. Panels are pieces
// of cloth that are flattened one by one; they meet at points, and each panel has corners of its
// own there.
struct QuadNet {
  struct Point {
    glm::vec3 place{0.0f};
    float slack = 0.0f;  // [0, 1]: how freely Relax() may move it
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

// Adds quads for the cells of a grid to `panel`. `skip(row, column)` (optional) leaves out the cell
// with that low corner. Seen from outside, rows run upward and columns to the right, or to the left
// if `mirrored`. The first UVs of the corners are their grid positions, scaled by mean edge
// lengths.
void AddPatch(const PointGrid& grid, int panel, bool mirrored,
              const std::function<bool(int, int)>& skip, QuadNet* net);

// Moves points with slack toward the mean of their neighbours, on the surface of `solid`.
void Relax(const Solid& solid, int rounds, QuadNet* net);

// Splits each quad into four. New points lie on the surface of `solid`; their influences and UVs
// are means.
void Subdivide(const Solid& solid, QuadNet* net);

// Averages the influences with those of the neighbours, `rounds` times. Keeps the strongest four.
void SmoothInfluences(int rounds, QuadNet* net);

// Appends a net to another one, without shared points.
void Join(const QuadNet& from, QuadNet* to);

// Appends the net to a mesh with one vertex per corner. Does not set normals and tangents.
void AppendNet(const QuadNet& net, character::Mesh* mesh);

// The neighbours of each point along the edges of quads, without repetition, in ascending order.
[[nodiscard]] std::vector<std::vector<int>> Neighbours(const QuadNet& net);

}  // namespace furrow::authoring

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "authoring/generator/head/head_chart.h"

namespace furrow::authoring {

// Levels of detail. Each level has cells half as large as the level before.
inline constexpr int kCoarsestLevel = 0;  // about 3,000 triangles for the whole head
inline constexpr int kDefaultLevel = 1;
inline constexpr int kFinestLevel = 2;

// The grid of a head's vertices at one level of detail. It covers the chart of the head (column
// around the head, row from neck to crown; see head_chart.h). Around the eyes and the mouth the
// grid is warped so that edges follow their outlines; cells inside the openings are left out.
// Vertices of a coarser level are a subset of those of the finest level.
class HeadGrid {
 public:
  // `shape` must outlive the grid. `level` is clamped to [kCoarsestLevel, kFinestLevel].
  explicit HeadGrid(const HeadShape& shape, int level = kDefaultLevel);

  [[nodiscard]] const HeadShape& shape() const { return *shape_; }
  [[nodiscard]] int level() const { return level_; }
  // Columns on each side: vertices have columns [-num_columns(), num_columns()].
  [[nodiscard]] int num_columns() const { return kHeadColumns * kFine / stride_; }
  // Rows of vertices: [0, num_rows()).
  [[nodiscard]] int num_rows() const { return num_fine_rows_ / stride_ + 1; }
  // The first (`i` = 0) and the last (1) row of the opening of the eyes, and of the mouth.
  [[nodiscard]] int eye_row(int i) const { return fine_eye_rows_[i] / stride_; }
  [[nodiscard]] int mouth_row(int i) const { return fine_mouth_rows_[i] / stride_; }

  // The chart coordinates of the vertex (column, row), before and after warping.
  [[nodiscard]] glm::vec2 Plain(int column, int row) const;
  [[nodiscard]] glm::vec2 Warped(int column, int row) const;
  // The surface point at chart coordinates, head space, centimetres.
  [[nodiscard]] glm::vec3 Surface(const glm::vec2& place) const {
    return HeadSurface(*shape_, place);
  }
  // True if the cell between the vertices (column, row) and (column + 1, row + 1) is inside the
  // opening of an eye or the mouth.
  [[nodiscard]] bool InOpening(int column, int row) const;
  // The outline of an opening as (column, row), counter-clockwise from outside: the left eye from
  // its inner corner, the mouth from the subject's left corner.
  [[nodiscard]] std::vector<glm::ivec2> EyeOutline() const { return EyeOutline(stride_); }
  [[nodiscard]] std::vector<glm::ivec2> MouthOutline() const { return MouthOutline(stride_); }

 private:
  static constexpr int kFine = 2;  // finest cells per cell of the chart
  [[nodiscard]] std::vector<glm::ivec2> EyeOutline(int stride) const;
  [[nodiscard]] std::vector<glm::ivec2> MouthOutline(int stride) const;
  void DrawToOutlines();
  void Relax(const std::vector<char>& fixed);

  const HeadShape* shape_;
  int level_ = kDefaultLevel;
  int stride_ = 2;  // finest cells per cell of this level
  int num_fine_rows_ = 0;
  int fine_eye_rows_[2] = {0, 0};
  int fine_mouth_rows_[2] = {0, 0};
  std::vector<glm::vec2>
      offset_;  // offsets of the finest vertices with column >= 0, in chart coordinates
};

}  // namespace furrow::authoring

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "authoring/generator/head/head_chart.h"

namespace furrow::authoring {

// Levels of detail: cells are twice as fine from one to the next.
inline constexpr int kCoarsestLevel = 0;  // the whole head has about 3,000 triangles
inline constexpr int kDefaultLevel = 1;
inline constexpr int kFinestLevel = 2;

// The grid of vertices over the head's chart at one level of detail. Around the eyes and the mouth
// it is drawn to their outlines, so that edges follow them; the cells inside are left out. All
// levels are samples of the finest one: their vertices coincide.
class HeadGrid {
 public:
  // `shape` must outlive it. `level` is clamped to the levels above.
  explicit HeadGrid(const HeadShape& shape, int level = kDefaultLevel);

  [[nodiscard]] const HeadShape& shape() const { return *shape_; }
  [[nodiscard]] int level() const { return level_; }
  [[nodiscard]] int num_columns() const { return kHeadColumns * kFine / stride_; }  // on a side
  [[nodiscard]] int num_rows() const { return num_fine_rows_ / stride_ + 1; }       // of vertices
  [[nodiscard]] int eye_row(int i) const { return fine_eye_rows_[i] / stride_; }  // first and last
  [[nodiscard]] int mouth_row(int i) const { return fine_mouth_rows_[i] / stride_; }

  // Where grid vertex (column, row) lies on the chart before and after the drawing to outlines.
  [[nodiscard]] glm::vec2 Plain(int column, int row) const;
  [[nodiscard]] glm::vec2 Warped(int column, int row) const;
  // The surface point, head space.
  [[nodiscard]] glm::vec3 Surface(const glm::vec2& place) const {
    return HeadSurface(*shape_, place);
  }
  // True where the cell whose low corner this is belongs to the opening of an eye or the mouth.
  [[nodiscard]] bool InOpening(int column, int row) const;
  // An opening's outline in order, in (column, row): counter-clockwise seen from outside, for the
  // left eye (from its inner corner) and the mouth (from the subject's left corner).
  [[nodiscard]] std::vector<glm::ivec2> EyeOutline() const { return EyeOutline(stride_); }
  [[nodiscard]] std::vector<glm::ivec2> MouthOutline() const { return MouthOutline(stride_); }

 private:
  static constexpr int kFine = 2;  // finest cells across a cell of the chart
  [[nodiscard]] std::vector<glm::ivec2> EyeOutline(int stride) const;
  [[nodiscard]] std::vector<glm::ivec2> MouthOutline(int stride) const;
  void DrawToOutlines();
  void Relax(const std::vector<char>& fixed);

  const HeadShape* shape_;
  int level_ = kDefaultLevel;
  int stride_ = 2;  // finest cells across a cell of this level
  int num_fine_rows_ = 0;
  int fine_eye_rows_[2] = {0, 0};
  int fine_mouth_rows_[2] = {0, 0};
  std::vector<glm::vec2> offset_;  // of the finest vertices with column >= 0, in places
};

}  // namespace furrow::authoring

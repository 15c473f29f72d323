// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace furrow::character::generator {

// The layout of the head's grid: columns run round the head (0 in front, +-kColumns at the back),
// rows from the neck to the crown. A fractional (column, row) names a place on the surface and in
// the texture. Around the eyes and the mouth the grid is drawn to their outlines, so that edges
// follow them; the cells inside are left out.
class HeadGrid {
 public:
  static constexpr int kColumns = 29;  // on either side
  static constexpr int kEyeColumns[2] = {5, 11};
  static constexpr int kMouthColumn = 7;

  HeadGrid();

  [[nodiscard]] int num_rows() const { return num_rows_; }  // of vertices; the last is the crown
  [[nodiscard]] int eye_row(int i) const { return eye_rows_[i]; }      // first and last
  [[nodiscard]] int mouth_row(int i) const { return mouth_rows_[i]; }  // first and last

  // Where grid vertex (column, row) lies after the drawing to outlines, in fractional coordinates.
  [[nodiscard]] glm::vec2 Warped(int column, int row) const;
  // The surface point, head space.
  [[nodiscard]] glm::vec3 Surface(const glm::vec2& place) const;
  // Texture coordinates in the square [0, 1] x [0, 1] of the head's island, v down.
  [[nodiscard]] glm::vec2 Uv(const glm::vec2& place) const;
  // True where the cell whose low corner this is belongs to the opening of an eye or the mouth.
  [[nodiscard]] bool InOpening(int column, int row) const;
  // Half-columns of an opening's outline in order: counter-clockwise seen from outside, for the
  // left eye (from its inner corner) and the mouth (from the subject's left corner).
  [[nodiscard]] std::vector<glm::ivec2> EyeOutline() const;
  [[nodiscard]] std::vector<glm::ivec2> MouthOutline() const;

 private:
  [[nodiscard]] glm::vec2 PlaceAt(float x, float y) const;  // of a point in front, by its x and y
  void DrawToOutlines();
  void Relax(const std::vector<char>& fixed);

  int num_rows_ = 0;
  int eye_rows_[2] = {0, 0};
  int mouth_rows_[2] = {0, 0};
  std::vector<glm::vec2> offset_;  // (kColumns + 1) x num_rows_, for columns >= 0
  std::vector<float> u_;           // of whole columns
  std::vector<float> v_;           // of whole rows
};

}  // namespace furrow::character::generator

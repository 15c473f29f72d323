// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/head/head_grid.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "authoring/generator/mesh/mesh_tools.h"

namespace furrow::authoring {
namespace {

// The columns of the openings on the chart.
constexpr int kEyeColumns[2] = {6, 14};
constexpr int kMouthColumn = 8;

// y of the upper or lower lid at s in [0, 1] from the inner to the outer corner.
float LidHeight(float s, bool upper) {
  const float tilt = -0.10f + 0.20f * s;
  const float pi = std::numbers::pi_v<float>;
  if (upper)
    return tilt + 0.61f * std::pow(std::max(std::sin(pi * std::pow(s, 0.86f)), 0.0f), 0.75f);
  return tilt - 0.53f * std::pow(std::max(std::sin(pi * std::pow(s, 1.12f)), 0.0f), 0.85f);
}

// `count` + 1 points of a lid at equal distances, from the inner corner.
std::vector<glm::vec2> LidPoints(int count, bool upper) {
  constexpr int kFine = 200;
  std::vector<glm::vec2> fine;
  std::vector<float> length{0.0f};
  for (int i = 0; i <= kFine; ++i) {
    const float s = static_cast<float>(i) / kFine;
    fine.emplace_back(kInnerCanthusX + (kOuterCanthusX - kInnerCanthusX) * s, LidHeight(s, upper));
    if (i > 0) length.push_back(length.back() + glm::distance(fine[i], fine[i - 1]));
  }
  std::vector<glm::vec2> points;
  std::size_t at = 0;
  for (int i = 0; i <= count; ++i) {
    // Even distances along the lid and not even parameters, so that quads do not bunch up at the
    // corners.
    const float want = length.back() * static_cast<float>(i) / static_cast<float>(count);
    while (at + 1 < fine.size() && length[at] < want) ++at;
    points.push_back(fine[at]);
  }
  return points;
}

// y of the line between the lips.
float MouthLine(float x) {
  return kMouthY - 0.035f * Bump(x, 0.35f) + 0.04f * Bump(x - 0.85f, 0.5f) - 0.022f * x;
}

}  // namespace

HeadGrid::HeadGrid(const HeadShape& shape, int level) : shape_(&shape) {
  level_ = std::clamp(level, kCoarsestLevel, kFinestLevel);
  stride_ = 4 >> level_;
  num_fine_rows_ = (NumHeadRows() - 1) * kFine;
  fine_eye_rows_[0] = FindHeadRow(-0.5f) * kFine;
  fine_eye_rows_[1] = FindHeadRow(0.5f) * kFine;
  fine_mouth_rows_[0] = FindHeadRow(-7.15f) * kFine;
  fine_mouth_rows_[1] = FindHeadRow(-6.65f) * kFine;
  offset_.assign(static_cast<std::size_t>(kHeadColumns * kFine + 1) * (num_fine_rows_ + 1),
                 glm::vec2(0.0f));
  DrawToOutlines();
}

glm::vec2 HeadGrid::Plain(int column, int row) const {
  return glm::vec2(column * stride_, row * stride_) / static_cast<float>(kFine);
}

glm::vec2 HeadGrid::Warped(int column, int row) const {
  const int fine_column = std::abs(column) * stride_;
  const glm::vec2 offset =
      offset_[static_cast<std::size_t>(fine_column) * (num_fine_rows_ + 1) + row * stride_];
  const glm::vec2 plain = Plain(column, row);
  return {plain.x + (column < 0 ? -offset.x : offset.x), plain.y + offset.y};
}

bool HeadGrid::InOpening(int column, int row) const {
  const int c = (column >= 0 ? column : -column - 1) * stride_;
  const int r = row * stride_;
  if (r >= fine_eye_rows_[0] && r < fine_eye_rows_[1] && c >= kEyeColumns[0] * kFine &&
      c < kEyeColumns[1] * kFine) {
    return true;
  }
  return r >= fine_mouth_rows_[0] && r < fine_mouth_rows_[1] && c < kMouthColumn * kFine;
}

std::vector<glm::ivec2> HeadGrid::EyeOutline(int stride) const {
  const int low = fine_eye_rows_[0] / stride, high = fine_eye_rows_[1] / stride;
  const int inner = kEyeColumns[0] * kFine / stride, outer = kEyeColumns[1] * kFine / stride;
  const int middle = (low + high) / 2;
  std::vector<glm::ivec2> outline;  // +x is on the viewer's right, so the outline first runs down
  for (int r = middle; r > low; --r) outline.emplace_back(inner, r);
  for (int c = inner; c < outer; ++c) outline.emplace_back(c, low);
  for (int r = low; r < high; ++r) outline.emplace_back(outer, r);
  for (int c = outer; c > inner; --c) outline.emplace_back(c, high);
  for (int r = high; r > middle; --r) outline.emplace_back(inner, r);
  return outline;
}

std::vector<glm::ivec2> HeadGrid::MouthOutline(int stride) const {
  const int low = fine_mouth_rows_[0] / stride, high = fine_mouth_rows_[1] / stride;
  const int corner = kMouthColumn * kFine / stride, middle = (low + high) / 2;
  std::vector<glm::ivec2> outline;
  for (int r = middle; r < high; ++r) outline.emplace_back(corner, r);
  for (int c = corner; c > -corner; --c) outline.emplace_back(c, high);
  for (int r = high; r > low; --r) outline.emplace_back(-corner, r);
  for (int c = -corner; c < corner; ++c) outline.emplace_back(c, low);
  for (int r = low; r < middle; ++r) outline.emplace_back(corner, r);
  return outline;
}

void HeadGrid::DrawToOutlines() {
  std::vector<char> fixed(offset_.size(), 0);
  // Fixes a grid point to a place on the outline of an opening. Offsets are relative to the plain
  // grid.
  const auto pin = [&](const glm::ivec2& vertex, float x, float y) {
    const std::size_t i = static_cast<std::size_t>(vertex.x) * (num_fine_rows_ + 1) + vertex.y;
    offset_[i] = HeadPlaceAt(*shape_, x, y) - glm::vec2(vertex) / static_cast<float>(kFine);
    fixed[i] = 1;
  };
  const std::vector<glm::ivec2> eye = EyeOutline(1);
  const int half = static_cast<int>(eye.size()) / 2;
  const std::vector<glm::vec2> lower = LidPoints(half, false);
  const std::vector<glm::vec2> upper = LidPoints(half, true);
  for (int i = 0; i <= half; ++i) pin(eye[i], lower[i].x, lower[i].y);
  for (int i = 1; i < half; ++i) pin(eye[2 * half - i], upper[i].x, upper[i].y);

  constexpr float kGap =
      0.002f;  // the lips touch; the gap separates points above and below the line
  const std::vector<glm::ivec2> mouth = MouthOutline(1);
  const int quarter = static_cast<int>(mouth.size()) / 4;  // from the left corner to the middle
  for (int i = 0; i <= quarter; ++i) {
    const float x = kMouthCornerX * (1.0f - static_cast<float>(i) / static_cast<float>(quarter));
    const float gap = i == 0 ? 0.0f : kGap;
    pin(mouth[i], x, MouthLine(x) + gap);
    pin(mouth[(mouth.size() - i) % mouth.size()], x, MouthLine(x) - gap);
  }
  Relax(fixed);
}

// Gauss-Seidel sweeps: each free point takes the mean of its neighbours and thus follows the pinned
// outlines smoothly. The first and last row and the last column stay in place.
void HeadGrid::Relax(const std::vector<char>& fixed) {
  constexpr float kHold =
      0.982f;  // pulls toward the plain grid, so that distant points do not move
  const int columns = kHeadColumns * kFine;
  const int rows = num_fine_rows_ + 1;
  const auto at = [&](int c, int r) -> glm::vec2& {
    return offset_[static_cast<std::size_t>(c) * rows + r];
  };
  for (int sweep = 0; sweep < 400; ++sweep) {
    for (int c = 0; c < columns; ++c) {
      for (int r = 1; r + 1 < rows; ++r) {
        if (fixed[static_cast<std::size_t>(c) * rows + r]) continue;
        // Column -1 is the mirror image of column 1.
        const glm::vec2 before = c > 0 ? at(c - 1, r) : glm::vec2(-at(1, r).x, at(1, r).y);
        glm::vec2 mean = 0.25f * (before + at(c + 1, r) + at(c, r - 1) + at(c, r + 1));
        if (c == 0) mean.x = 0.0f;
        at(c, r) = mean * kHold;
      }
    }
  }
}

}  // namespace furrow::authoring

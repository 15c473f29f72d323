// SPDX-License-Identifier: Apache-2.0
#include "character/generator/head_grid.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "character/generator/head_shape.h"
#include "character/generator/mesh_tools.h"

namespace furrow::character::generator {
namespace {

constexpr float kDegrees = std::numbers::pi_v<float> / 180.0f;
constexpr float kFrontRadius = 8.3f;  // centimetres from the axis, where rows' heights are measured

// Azimuths of the columns, degrees: dense where the face is.
constexpr float kAzimuth[HeadGrid::kColumns + 1] = {
    0,     2.6f,  5.2f, 7.8f, 10.3f, 12.8f, 15.8f, 18.9f, 22.0f, 25.2f,
    28.4f, 31.6f, 35,   39,   43.5f, 48.5f, 54,    60,    67,    75,
    83,    91,    99,   108,  118,   129,   141,   154,   167,   180};

// A row of the grid: a fan of rays from (0, base, axis) at `elevation`; `base` follows from the
// height that the row has in front. Rays that look up show the undersides of nose and chin.
struct Row {
  float height;          // in front, centimetres
  float elevation;       // degrees, in front
  float axis;            // z of the fan's origin
  float half_width;      // degrees of azimuth within which the elevation holds
  float texture_height;  // share of the texture that the step from the row below takes
};

constexpr Row kRows[] = {{-22.5f, 0, -3.9f, 90, 0.0f},
                         {-20.0f, 0, -3.8f, 90, 0.8f},
                         {-17.8f, 0, -3.7f, 90, 0.8f},
                         {-15.9f, 0, -3.5f, 90, 0.7f},
                         {-14.3f, 0, -3.2f, 90, 0.7f},
                         {-13.1f, 0, -3.0f, 90, 0.6f},
                         // Under the chin: heights follow from the fan's origin at (0, -8.5, 1).
                         {-23.0f, -60, 1.0f, 75, 0.6f},
                         {-18.6f, -50.5f, 1.0f, 75, 0.6f},
                         {-16.0f, -42, 1.0f, 75, 0.6f},
                         {-14.1f, -34, 1.0f, 75, 0.6f},
                         {-12.7f, -27, 1.0f, 75, 0.6f},
                         {-11.55f, -20, 1.0f, 75, 0.6f},
                         {-10.75f, -15, 1.0f, 75, 0.55f},
                         {-10.1f, -11, 1.0f, 75, 0.55f},
                         {-9.6f, -7.5f, 1.0f, 75, 0.5f},
                         {-9.15f, -4, 1.0f, 75, 0.45f},
                         {-8.75f, -1.5f, 1.0f, 75, 0.4f},
                         {-8.35f, 0, 1.0f, 40, 0.4f},
                         {-7.95f, 0, 1.0f, 40, 0.4f},
                         {-7.6f, 0, 1.0f, 40, 0.35f},
                         {-7.3f, 0, 1.0f, 40, 0.3f},
                         // Mouth.
                         {-7.1f, 0, 1.0f, 40, 0.25f},
                         {-6.95f, 0, 1.0f, 40, 0.2f},
                         {-6.8f, 0, 1.0f, 40, 0.2f},
                         {-6.6f, 0, 1.0f, 40, 0.25f},
                         {-6.35f, 0, 1.0f, 40, 0.3f},
                         {-6.1f, -4, 1.0f, 34, 0.3f},
                         {-5.8f, -12, 1.0f, 32, 0.3f},
                         {-5.5f, -21, 1.0f, 30, 0.3f},
                         // Under the nose.
                         {-5.2f, -31, 1.0f, 28, 0.3f},
                         {-4.95f, -38, 1.0f, 28, 0.3f},
                         {-4.7f, -41, 1.0f, 28, 0.3f},
                         {-4.45f, -40, 1.0f, 28, 0.3f},
                         {-4.15f, -35, 1.0f, 28, 0.3f},
                         {-3.8f, -28, 1.0f, 28, 0.4f},
                         {-3.4f, -21, 1.0f, 28, 0.4f},
                         {-2.95f, -14, 1.0f, 28, 0.4f},
                         {-2.5f, -8, 1.0f, 28, 0.4f},
                         {-2.05f, -3, 1.0f, 28, 0.4f},
                         {-1.65f, 0, 1.0f, 28, 0.4f},
                         {-1.3f, 0, 1.0f, 28, 0.35f},
                         {-1.0f, 0, 1.0f, 28, 0.3f},
                         {-0.75f, 0, 1.0f, 28, 0.25f},
                         // Eyes.
                         {-0.5f, 0, 1.0f, 28, 0.25f},
                         {-0.25f, 0, 1.0f, 28, 0.25f},
                         {0.0f, 0, 1.0f, 28, 0.25f},
                         {0.25f, 0, 1.0f, 28, 0.25f},
                         {0.5f, 0, 1.0f, 28, 0.25f},
                         {0.72f, 0, 1.0f, 28, 0.25f},
                         {0.95f, 0, 1.0f, 28, 0.25f},
                         {1.2f, 0, 1.0f, 28, 0.25f},
                         {1.5f, 0, 1.0f, 28, 0.3f},
                         {1.85f, 0, 1.0f, 28, 0.35f},
                         {2.25f, 0, 1.0f, 28, 0.4f},
                         {2.7f, 0, 1.0f, 28, 0.45f},
                         {3.25f, 0, 1.0f, 40, 0.55f},
                         {3.85f, 0, 0.8f, 60, 0.6f},
                         {4.5f, 2, 0.6f, 180, 0.65f},
                         {5.2f, 5, 0.3f, 180, 0.7f},
                         {6.0f, 10, 0.0f, 180, 0.7f},
                         {6.9f, 16, -0.3f, 180, 0.6f},
                         // Crown.
                         {7.9f, 23, -0.6f, 180, 0.6f},
                         {9.15f, 31, -0.8f, 180, 0.6f},
                         {11.0f, 40, -0.8f, 180, 0.6f},
                         {14.0f, 51, -0.8f, 180, 0.6f},
                         {19.5f, 62.5f, -0.8f, 180, 0.6f},
                         {34.5f, 75, -0.8f, 180, 0.6f},
                         {34.5f, 90, -0.8f, 180, 0.6f}};

constexpr int kNumRows = static_cast<int>(std::size(kRows));
constexpr float kCrownBase = 3.5f;  // where the fans of the crown come from
constexpr float kBackHigh = 4.5f;   // at the back rows are even between the neck and this height

float Lerp(const auto& value, float index, int count) {
  const int low = std::clamp(static_cast<int>(std::floor(index)), 0, count - 2);
  const float t = std::clamp(index - static_cast<float>(low), 0.0f, 1.0f);
  return value(low) + (value(low + 1) - value(low)) * t;
}

float RowField(float Row::*field, float row) {
  return Lerp([&](int i) { return kRows[i].*field; }, row, kNumRows);
}

float Azimuth(float column) {
  const float a = Lerp([](int i) { return kAzimuth[i]; }, std::abs(column), HeadGrid::kColumns + 1);
  return column < 0.0f ? -a : a;
}

// y of the upper and the lower lid at s in [0, 1] from the inner to the outer corner.
float LidHeight(float s, bool upper) {
  const float tilt = -0.10f + 0.20f * s;
  const float pi = std::numbers::pi_v<float>;
  if (upper)
    return tilt + 0.50f * std::pow(std::max(std::sin(pi * std::pow(s, 0.86f)), 0.0f), 0.75f);
  return tilt - 0.53f * std::pow(std::max(std::sin(pi * std::pow(s, 1.12f)), 0.0f), 0.85f);
}

// `count` + 1 points of a lid at equal distances, inner corner first.
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
    const float want = length.back() * static_cast<float>(i) / static_cast<float>(count);
    while (at + 1 < fine.size() && length[at] < want) ++at;
    points.push_back(fine[at]);
  }
  return points;
}

int FindRow(float height) {
  for (int i = 0; i < kNumRows; ++i) {
    if (std::abs(kRows[i].height - height) < 1e-3f) return i;
  }
  return -1;
}

// 0 where columns belong to the face, 1 at the sides and the back.
float Turn(float azimuth) { return SmoothStep(36.0f, 100.0f, azimuth); }

// z of a fan's origin: far from the front it runs evenly from the neck to the skull.
float FanAxis(float row, float azimuth) {
  constexpr Knot kBack[] = {{0, -3.8f}, {5, -3.1f}, {34, -0.8f}, {57, 0.0f}};
  const float front = RowField(&Row::axis, row);
  if (row >= static_cast<float>(FindRow(4.5f))) return front;
  return front + (Interpolate(kBack, row) - front) * Turn(azimuth);
}

// Height of a fan's origin.
float FanBase(float row, float azimuth, float elevation) {
  static const int first_crown = FindRow(6.0f);
  static const int first_chin = FindRow(-23.0f);
  const float height = RowField(&Row::height, row);
  const float front = height - kFrontRadius * std::tan(RowField(&Row::elevation, row) * kDegrees);
  const float crown = SmoothStep(static_cast<float>(first_crown), first_crown + 6.0f, row);
  if (crown > 0.0f) return front + (kCrownBase - front) * crown;
  // Fans under the chin stay where they are while they open to the sides; all others keep the
  // height at which they meet the face.
  const float chin = SmoothStep(first_chin - 1.0f, static_cast<float>(first_chin), row) *
                     (1.0f - SmoothStep(first_chin + 11.0f, first_chin + 12.0f, row));
  const float level = height - kFrontRadius * std::tan(elevation);
  const float base = level + (front - level) * chin;
  // Far from the front a row has the height that the even spacing of the back gives it.
  const Knot back_knots[] = {{0.0f, kRows[0].height},
                             {static_cast<float>(first_chin - 1), kRows[first_chin - 1].height},
                             {static_cast<float>(first_crown), kBackHigh}};
  const float back = Interpolate(back_knots, row);
  return base + (back - base) * Turn(azimuth);
}

}  // namespace

HeadGrid::HeadGrid() : num_rows_(kNumRows) {
  eye_rows_[0] = FindRow(-0.5f);
  eye_rows_[1] = FindRow(0.5f);
  mouth_rows_[0] = FindRow(-7.1f);
  mouth_rows_[1] = FindRow(-6.8f);
  u_.push_back(0.0f);
  for (int c = 1; c <= kColumns; ++c) {
    const float middle = 0.5f * (kAzimuth[c] + kAzimuth[c - 1]);
    u_.push_back(u_.back() +
                 (kAzimuth[c] - kAzimuth[c - 1]) * (1.0f - 0.65f * SmoothStep(50, 105, middle)));
  }
  v_.push_back(0.0f);
  for (int r = 1; r < kNumRows; ++r) v_.push_back(v_.back() + kRows[r].texture_height);
  for (float& u : u_) u /= u_.back();
  const float total = v_.back();
  for (float& v : v_) v /= total;
  offset_.assign(static_cast<std::size_t>(kColumns + 1) * kNumRows, glm::vec2(0.0f));
  DrawToOutlines();
}

glm::vec2 HeadGrid::Warped(int column, int row) const {
  const glm::vec2 offset = offset_[static_cast<std::size_t>(std::abs(column)) * num_rows_ + row];
  const float side = column < 0 ? -1.0f : 1.0f;
  return {side * (static_cast<float>(std::abs(column)) + offset.x),
          static_cast<float>(row) + offset.y};
}

glm::vec3 HeadGrid::Surface(const glm::vec2& place) const {
  const float azimuth = Azimuth(place.x);
  const float row = std::clamp(place.y, 0.0f, static_cast<float>(kNumRows - 1));
  const float half_width = RowField(&Row::half_width, row);
  const float hold = half_width >= 180.0f
                         ? 1.0f
                         : 1.0f - SmoothStep(0.35f * half_width, half_width, std::abs(azimuth));
  const float elevation = RowField(&Row::elevation, row) * hold * kDegrees;
  const float base = FanBase(row, std::abs(azimuth), elevation);
  const glm::vec3 direction(std::sin(azimuth * kDegrees) * std::cos(elevation), std::sin(elevation),
                            std::cos(azimuth * kDegrees) * std::cos(elevation));
  const glm::vec3 origin(0.0f, base, FanAxis(row, std::abs(azimuth)));
  constexpr float kFar = 20.0f;
  return CastOnHead(origin + direction * kFar, -direction, kFar);
}

glm::vec2 HeadGrid::Uv(const glm::vec2& place) const {
  const float u = Lerp([&](int i) { return u_[i]; }, std::abs(place.x), kColumns + 1);
  const float v = Lerp([&](int i) { return v_[i]; }, place.y, kNumRows);
  return {0.5f + 0.5f * (place.x < 0.0f ? -u : u), 1.0f - v};
}

bool HeadGrid::InOpening(int column, int row) const {
  const int c = column >= 0 ? column : -column - 1;
  if (row >= eye_rows_[0] && row < eye_rows_[1] && c >= kEyeColumns[0] && c < kEyeColumns[1]) {
    return true;
  }
  return row >= mouth_rows_[0] && row < mouth_rows_[1] && c < kMouthColumn;
}

std::vector<glm::ivec2> HeadGrid::EyeOutline() const {
  const int middle = (eye_rows_[0] + eye_rows_[1]) / 2;
  std::vector<glm::ivec2> outline;  // +x is to the right as the viewer sees it: down first
  for (int r = middle; r > eye_rows_[0]; --r) outline.emplace_back(kEyeColumns[0], r);
  for (int c = kEyeColumns[0]; c < kEyeColumns[1]; ++c) outline.emplace_back(c, eye_rows_[0]);
  for (int r = eye_rows_[0]; r < eye_rows_[1]; ++r) outline.emplace_back(kEyeColumns[1], r);
  for (int c = kEyeColumns[1]; c > kEyeColumns[0]; --c) outline.emplace_back(c, eye_rows_[1]);
  for (int r = eye_rows_[1]; r > middle; --r) outline.emplace_back(kEyeColumns[0], r);
  return outline;
}

std::vector<glm::ivec2> HeadGrid::MouthOutline() const {
  const int middle = mouth_rows_[0] + 1;
  std::vector<glm::ivec2> outline;
  outline.emplace_back(kMouthColumn, middle);
  for (int c = kMouthColumn; c >= -kMouthColumn; --c) outline.emplace_back(c, mouth_rows_[1]);
  outline.emplace_back(-kMouthColumn, middle);
  for (int c = -kMouthColumn; c <= kMouthColumn; ++c) outline.emplace_back(c, mouth_rows_[0]);
  return outline;
}

glm::vec2 HeadGrid::PlaceAt(float x, float y) const {
  const glm::vec3 p = CastOnHead({x, y, 20.0f}, {0, 0, -1}, 20.0f);
  float row = static_cast<float>(FindRow(-9.15f));  // rows below are not in order of height
  while (kRows[static_cast<int>(row) + 1].height < y) row += 1.0f;
  const Row& low = kRows[static_cast<int>(row)];
  const Row& high = kRows[static_cast<int>(row) + 1];
  row += (y - low.height) / (high.height - low.height);
  const float azimuth = std::atan2(x, p.z - RowField(&Row::axis, row)) / kDegrees;
  int column = 0;
  while (column + 2 <= kColumns && kAzimuth[column + 1] < azimuth) ++column;
  return {static_cast<float>(column) +
              (azimuth - kAzimuth[column]) / (kAzimuth[column + 1] - kAzimuth[column]),
          row};
}

void HeadGrid::DrawToOutlines() {
  std::vector<char> fixed(offset_.size(), 0);
  const auto pin = [&](const glm::ivec2& vertex, float x, float y) {
    const std::size_t i = static_cast<std::size_t>(vertex.x) * num_rows_ + vertex.y;
    offset_[i] = PlaceAt(x, y) - glm::vec2(vertex);
    fixed[i] = 1;
  };
  const std::vector<glm::ivec2> eye = EyeOutline();
  const int half = static_cast<int>(eye.size()) / 2;
  const std::vector<glm::vec2> lower = LidPoints(half, false);
  const std::vector<glm::vec2> upper = LidPoints(half, true);
  for (int i = 0; i <= half; ++i) pin(eye[i], lower[i].x, lower[i].y);
  for (int i = 1; i < half; ++i) pin(eye[2 * half - i], upper[i].x, upper[i].y);
  constexpr float kGap = 0.018f;
  const auto line = [](float x) { return kMouthY + 0.05f * Bump(x - 0.7f, 0.5f) - 0.02f * x; };
  for (int c = 0; c <= kMouthColumn; ++c) {
    const float x = kMouthCornerX * (static_cast<float>(c) / (kMouthColumn + 0.7f));
    pin({c, mouth_rows_[0]}, x, line(x) - kGap);
    pin({c, mouth_rows_[1]}, x, line(x) + kGap);
  }
  pin({kMouthColumn, mouth_rows_[0] + 1}, kMouthCornerX, line(kMouthCornerX));
  Relax(fixed);
}

void HeadGrid::Relax(const std::vector<char>& fixed) {
  constexpr float kHold = 0.93f;  // pulls back to the plain grid, so that far places do not move
  const auto at = [&](int c, int r) -> glm::vec2& {
    return offset_[static_cast<std::size_t>(c) * num_rows_ + r];
  };
  for (int sweep = 0; sweep < 120; ++sweep) {
    for (int c = 0; c < kColumns; ++c) {
      for (int r = 1; r + 1 < num_rows_; ++r) {
        if (fixed[static_cast<std::size_t>(c) * num_rows_ + r]) continue;
        // Column -1 mirrors column 1.
        const glm::vec2 before = c > 0 ? at(c - 1, r) : glm::vec2(-at(1, r).x, at(1, r).y);
        glm::vec2 mean = 0.25f * (before + at(c + 1, r) + at(c, r - 1) + at(c, r + 1));
        if (c == 0) mean.x = 0.0f;
        at(c, r) = mean * kHold;
      }
    }
  }
}

}  // namespace furrow::character::generator

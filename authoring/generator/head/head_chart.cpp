// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/head/head_chart.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "authoring/generator/mesh/mesh_tools.h"
#include "base/scalar.h"

namespace furrow::authoring {
namespace {

constexpr float kFrontRadius =
    8.3f;  // centimetres from the axis, where the heights of rows are measured

// Azimuths of the columns, degrees. They are dense in the face.
constexpr float kAzimuth[kHeadColumns + 1] = {0,     2.4f,  4.8f, 7.1f,  9.4f,  11.7f, 14,    16.8f,
                                              19.8f, 22.9f, 26,   29.1f, 32.3f, 35.7f, 39.5f, 43.8f,
                                              48.6f, 54,    60,   67,    75,    83,    91,    99,
                                              108,   118,   129,  141,   154,   167,   180};

// A row of the grid: a fan of rays from (0, base, axis) at `elevation`. `base` follows from the
// row's height in front. Rays that point up reach the undersides of nose and chin.
struct Row {
  float height;          // in front, centimetres
  float elevation;       // degrees, in front
  float axis;            // z of the fan's origin
  float half_width;      // azimuth up to which the elevation applies, degrees
  float texture_height;  // height of the step from the row below, relative to the others
};

constexpr Row kRows[] = {{-22.5f, 0, -3.9f, 90, 0.0f},
                         {-21.2f, 0, -3.9f, 90, 0.4f},
                         {-19.8f, 0, -3.8f, 90, 0.5f},
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
                         {-7.95f, -6, 1.0f, 40, 0.4f},
                         {-7.65f, -7, 1.0f, 40, 0.35f},
                         {-7.4f, -4, 1.0f, 40, 0.3f},
                         // Mouth.
                         {-7.15f, 0, 1.0f, 40, 0.25f},
                         {-7.02f, 0, 1.0f, 40, 0.15f},
                         {-6.9f, 0, 1.0f, 40, 0.15f},
                         {-6.78f, 0, 1.0f, 40, 0.15f},
                         {-6.65f, 0, 1.0f, 40, 0.15f},
                         {-6.45f, 0, 1.0f, 40, 0.25f},
                         {-6.25f, 0, 1.0f, 40, 0.3f},
                         {-6.05f, -4, 1.0f, 34, 0.3f},
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
constexpr float kCrownBase = 3.5f;  // origin of the crown's fans
constexpr float kBackHigh =
    4.5f;  // at the back, rows are evenly spaced between the neck and this height

float Lerp(const auto& value, float index, int count) {
  const int low = std::clamp(static_cast<int>(std::floor(index)), 0, count - 2);
  const float t = std::clamp(index - static_cast<float>(low), 0.0f, 1.0f);
  return value(low) + (value(low + 1) - value(low)) * t;
}

float RowField(float Row::*field, float row) {
  return Lerp([&](int i) { return kRows[i].*field; }, row, kNumRows);
}

float Azimuth(float column) {
  const float a = Lerp([](int i) { return kAzimuth[i]; }, std::abs(column), kHeadColumns + 1);
  return column < 0.0f ? -a : a;
}

// 0 in the face, 1 at the sides and the back.
float Turn(float azimuth) { return Smoothstep(36.0f, 100.0f, azimuth); }

// z of a fan's origin. Far from the front it changes evenly from the neck to the skull.
float FanAxis(float row, float azimuth) {
  constexpr Knot kBack[] = {{0, -3.8f}, {6, -3.1f}, {37, -0.8f}, {60, 0.0f}};
  const float front = RowField(&Row::axis, row);
  if (row >= static_cast<float>(FindHeadRow(4.5f))) return front;
  return front + (Interpolate(kBack, row) - front) * Turn(azimuth);
}

// The height of a fan's origin.
float FanBase(float row, float azimuth, float elevation) {
  static const int first_crown = FindHeadRow(6.0f);
  static const int first_chin = FindHeadRow(-23.0f);
  const float height = RowField(&Row::height, row);
  const float front = height - kFrontRadius * std::tan(RowField(&Row::elevation, row) * kDegrees);
  const float crown = Smoothstep(static_cast<float>(first_crown), first_crown + 6.0f, row);
  if (crown > 0.0f) return front + (kCrownBase - front) * crown;
  // Fans under the chin keep their origin to the sides. All others keep the height at which they
  // meet the face.
  const float chin = Smoothstep(first_chin - 1.0f, static_cast<float>(first_chin), row) *
                     (1.0f - Smoothstep(first_chin + 11.0f, first_chin + 12.0f, row));
  const float level = height - kFrontRadius * std::tan(elevation);
  const float base = level + (front - level) * chin;
  // Far from the front, the even spacing of the back decides the height of a row.
  const Knot back_knots[] = {{0.0f, kRows[0].height},
                             {static_cast<float>(first_chin - 1), kRows[first_chin - 1].height},
                             {static_cast<float>(first_crown), kBackHigh}};
  const float back = Interpolate(back_knots, row);
  return base + (back - base) * Turn(azimuth);
}

// Texture coordinates of the columns and rows, from 0 to 1.
std::vector<float> TextureColumns() {
  std::vector<float> u{0.0f};
  for (int c = 1; c <= kHeadColumns; ++c) {
    const float middle = 0.5f * (kAzimuth[c] + kAzimuth[c - 1]);
    const float width = kAzimuth[c] - kAzimuth[c - 1];
    u.push_back(u.back() + width * (1.0f - 0.65f * Smoothstep(50, 105, middle)));
  }
  const float total = u.back();
  for (float& value : u) value /= total;
  return u;
}

std::vector<float> TextureRows() {
  std::vector<float> v{0.0f};
  for (int r = 1; r < kNumRows; ++r) v.push_back(v.back() + kRows[r].texture_height);
  const float total = v.back();
  for (float& value : v) value /= total;
  return v;
}

}  // namespace

int NumHeadRows() { return kNumRows; }

int FindHeadRow(float height) {
  for (int i = 0; i < kNumRows; ++i) {
    if (std::abs(kRows[i].height - height) < 1e-3f) return i;
  }
  return -1;
}

glm::vec3 HeadSurface(const HeadShape& shape, const glm::vec2& place) {
  const float azimuth = Azimuth(place.x);
  const float row = std::clamp(place.y, 0.0f, static_cast<float>(kNumRows - 1));
  const float half_width = RowField(&Row::half_width, row);
  const float hold = half_width >= 180.0f
                         ? 1.0f
                         : 1.0f - Smoothstep(0.35f * half_width, half_width, std::abs(azimuth));
  const float elevation = RowField(&Row::elevation, row) * hold * kDegrees;
  const float base = FanBase(row, std::abs(azimuth), elevation);
  const glm::vec3 direction(std::sin(azimuth * kDegrees) * std::cos(elevation), std::sin(elevation),
                            std::cos(azimuth * kDegrees) * std::cos(elevation));
  const glm::vec3 origin(0.0f, base, FanAxis(row, std::abs(azimuth)));
  constexpr float kFar = 20.0f;
  return shape.Cast(origin + direction * kFar, -direction, kFar);
}

glm::vec2 HeadUv(const glm::vec2& place) {
  static const std::vector<float> columns = TextureColumns();
  static const std::vector<float> rows = TextureRows();
  const float u = Lerp([&](int i) { return columns[i]; }, std::abs(place.x), kHeadColumns + 1);
  const float v = Lerp([&](int i) { return rows[i]; }, place.y, kNumRows);
  return {0.5f + 0.5f * (place.x < 0.0f ? -u : u), 1.0f - v};
}

glm::vec2 HeadPlaceAt(const HeadShape& shape, float x, float y) {
  const glm::vec3 p = shape.Cast({x, y, 20.0f}, {0, 0, -1}, 20.0f);
  float row = static_cast<float>(FindHeadRow(-9.15f));  // rows below are not ordered by height
  while (kRows[static_cast<int>(row) + 1].height < y) row += 1.0f;
  const Row& low = kRows[static_cast<int>(row)];
  const Row& high = kRows[static_cast<int>(row) + 1];
  row += (y - low.height) / (high.height - low.height);
  const float azimuth = std::atan2(x, p.z - RowField(&Row::axis, row)) / kDegrees;
  int column = 0;
  while (column + 2 <= kHeadColumns && kAzimuth[column + 1] < azimuth) ++column;
  return {static_cast<float>(column) +
              (azimuth - kAzimuth[column]) / (kAzimuth[column + 1] - kAzimuth[column]),
          row};
}

}  // namespace furrow::authoring

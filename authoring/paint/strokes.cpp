// SPDX-License-Identifier: Apache-2.0
#include "authoring/paint/strokes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "authoring/paint/dilate.h"

namespace furrow::authoring {

using glm::vec3;

StrokeLine::StrokeLine(std::vector<vec3> points) : points_(std::move(points)) {
  places_.assign(points_.size(), 0.0f);
  for (std::size_t i = 1; i < points_.size(); ++i) {
    places_[i] = places_[i - 1] + glm::distance(points_[i], points_[i - 1]);
  }
  length_ = places_.empty() ? 0.0f : places_.back();
  for (float& place : places_) place /= std::max(length_, 1e-9f);
}

StrokeLine::Nearest StrokeLine::FindNearest(const vec3& p) const {
  float best = std::numeric_limits<float>::max();
  std::size_t piece = 0;
  float place_in_piece = 0.0f;
  for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
    const vec3 along = points_[i + 1] - points_[i];
    const vec3 from = p - points_[i];
    const float t =
        std::clamp(glm::dot(from, along) / std::max(glm::dot(along, along), 1e-12f), 0.0f, 1.0f);
    const vec3 away = from - along * t;
    const float squared = glm::dot(away, away);
    if (squared >= best) continue;
    best = squared;
    piece = i;
    place_in_piece = t;
  }
  Nearest nearest;
  nearest.distance = std::sqrt(best);
  nearest.along = points_[piece + 1] - points_[piece];
  nearest.place = places_[piece] + (places_[piece + 1] - places_[piece]) * place_in_piece;
  const vec3 away = p - (points_[piece] + nearest.along * place_in_piece);
  if (nearest.distance > 1e-9f) nearest.away = away / nearest.distance;
  return nearest;
}

float StrokeTaper(float place, float taper) {
  // Distance from the nearer end, in units of the tapered part.
  const float end = std::min(place, 1.0f - place) / std::max(0.5f * taper, 1e-3f);
  const float x = std::clamp(end, 0.0f, 1.0f);
  return x * x * (3.0f - 2.0f * x);
}

// The factor 1 / (1 + ...) makes the bottom of the valley narrower than that of a Gaussian with the
// same foot, since skin creases rather than undulates.
FoldShape FoldShapeAt(float widths, float ridge) {
  const float x = widths;
  const float q = 1.0f + 14.0f * x * x;
  const float fade = std::exp(-x * x);
  const float valley = fade / q;
  const float valley_slope = -2.0f * x * valley - fade * 28.0f * x / (q * q);
  const float r = (x - 1.0f) * 2.0f;
  const float bump = ridge * std::exp(-r * r);
  return {bump - valley, -4.0f * r * bump - valley_slope};
}

character::Picture EncodeNormals(const std::vector<SurfaceTexel>& texels,
                                 std::span<const glm::vec2> slopes, int width, int height,
                                 int bits) {
  character::Picture picture;
  picture.width = width;
  picture.height = height;
  picture.channels = 3;
  picture.pixels16.resize(static_cast<std::size_t>(width) * height * 3, NormalTexel(0.0f));
  for (std::size_t i = 2; i < picture.pixels16.size(); i += 3) {
    picture.pixels16[i] = NormalTexel(1.0f);
  }
  for (std::size_t i = 0; i < texels.size() && i < slopes.size(); ++i) {
    const glm::vec3 n = glm::normalize(glm::vec3(slopes[i], 1.0f));
    const std::size_t at = (static_cast<std::size_t>(texels[i].y) * width + texels[i].x) * 3;
    for (int c = 0; c < 3; ++c) picture.pixels16[at + c] = NormalTexel(n[c]);
  }
  RoundNormals(bits, &picture);
  Dilate(&picture, texels, kSeamTexels);
  return picture;
}

std::uint16_t NormalTexel(float component) {
  return static_cast<std::uint16_t>(std::lround((component * 0.5f + 0.5f) * 65535.0f));
}

float NormalComponent(std::uint16_t texel) {
  return static_cast<float>(texel) / 65535.0f * 2.0f - 1.0f;
}

void RoundNormals(int bits, character::Picture* normals) {
  for (std::size_t i = 0; i < normals->pixels16.size(); ++i) {
    const long step = 1L << (i % 3 == 2 ? 18 - bits : 16 - bits);
    const long rounded = (normals->pixels16[i] + step / 2) / step * step;
    normals->pixels16[i] = static_cast<std::uint16_t>(std::min(rounded, 65535L));
  }
}

// A uniform Catmull-Rom spline through all points. End points count twice.
std::vector<glm::vec3> Smooth(std::span<const glm::vec3> points, int per_segment) {
  std::vector<glm::vec3> line;
  const int count = static_cast<int>(points.size());
  for (int i = 0; i + 1 < count; ++i) {
    const glm::vec3 p0 = points[std::max(i - 1, 0)];
    const glm::vec3 p1 = points[i];
    const glm::vec3 p2 = points[i + 1];
    const glm::vec3 p3 = points[std::min(i + 2, count - 1)];
    for (int k = 0; k < per_segment; ++k) {
      const float t = static_cast<float>(k) / static_cast<float>(per_segment);
      line.push_back(0.5f * (2.0f * p1 + (p2 - p0) * t +
                             (2.0f * p0 - 5.0f * p1 + 4.0f * p2 - p3) * (t * t) +
                             (3.0f * p1 - p0 - 3.0f * p2 + p3) * (t * t * t)));
    }
  }
  if (count > 0) line.push_back(points.back());
  return line;
}

}  // namespace furrow::authoring

// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/layers/stroke_layer.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <glm/geometric.hpp>

#include "base/status.h"

namespace furrow::character::bake {
namespace {

using glm::vec2;
using glm::vec3;

constexpr float kSteerWidths = 4.0f;  // within which folds of strain run along a drawn one
constexpr float kMetres = 0.001f;     // a millimetre
constexpr float kFarthest = 0.02f;    // metres off the surface
constexpr std::size_t kMostPoints = 200'000;

// 1 on the line, 0 at `reach` and beyond, smooth at both.
struct Falloff {
  float value = 0.0f;
  float slope = 0.0f;  // by the distance
};
Falloff FalloffAt(float distance, float reach) {
  const float x = distance / reach;
  if (x >= 1.0f) return {};
  const float q = 1.0f - x * x;
  return {q * q, -4.0f * x * q / reach};
}

// Metres between points on the line.
float PieceOf(const BakeStroke& stroke) { return std::max(stroke.width_mm * kMetres, 0.001f); }

std::string NameOf(const BakeStroke& stroke) { return "stroke '" + stroke.name + "'"; }

// Points on the line close enough to each other that straight pieces between them stay near the
// surface once the points are carried to it.
std::vector<vec3> Densify(const BakeStroke& stroke) {
  std::vector<vec3> line = stroke.points;
  if (stroke.smooth) line = paint::Smooth(stroke.points, 8);
  std::vector<vec3> dense;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const float length = glm::distance(line[i], line[i + 1]);
    const int pieces = std::clamp(static_cast<int>(std::ceil(length / PieceOf(stroke))), 1, 64);
    for (int k = 0; k < pieces; ++k) {
      dense.push_back(
          glm::mix(line[i], line[i + 1], static_cast<float>(k) / static_cast<float>(pieces)));
    }
  }
  dense.push_back(line.back());
  return dense;
}

float ReachOf(const BakeStroke& stroke) {
  const float width = stroke.width_mm * kMetres;
  return stroke.kind == BakeStroke::Kind::kFold ? kSteerWidths * width : width;
}

}  // namespace

float CavityOf(float height, float wavelength) {
  const float rise = 4.0f * std::max(-height, 0.0f) / std::max(wavelength, 1e-6f);
  return 1.0f / std::sqrt(1.0f + rise * rise);
}

Result<std::unique_ptr<StrokeLayer>> StrokeLayer::Create(
    const Surface& surface, const std::vector<const BakeStroke*>& strokes,
    std::vector<std::vector<float>> masks, float depth, Pace* pace) {
  std::unique_ptr<StrokeLayer> layer(new StrokeLayer(surface, depth));
  SurfaceReach reach(surface);
  std::vector<std::vector<std::uint32_t>> lists(surface.triangles().size());
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    if (!pace->Tell(static_cast<float>(i) / static_cast<float>(strokes.size()))) break;
    FURROW_RETURN_IF_ERROR(layer->Lay(*strokes[i], std::move(masks[i]), &reach, &lists, pace));
  }
  if (pace->stopped()) return Pace::Cancelled();
  layer->starts_.push_back(0);
  for (const auto& list : lists) {
    layer->lists_.insert(layer->lists_.end(), list.begin(), list.end());
    layer->starts_.push_back(layer->lists_.size());
  }
  return layer;
}

Status StrokeLayer::Lay(const BakeStroke& stroke, std::vector<float> mask, SurfaceReach* reach,
                        std::vector<std::vector<std::uint32_t>>* lists, Pace* pace) {
  std::vector<vec3> points = Densify(stroke);
  num_points_ += points.size();
  if (num_points_ > kMostPoints) {
    return {StatusCode::kLimit,
            "the strokes of one map are cut into more than " + std::to_string(kMostPoints) +
                " pieces, each as long as its stroke is wide",
            NameOf(stroke), "make strokes wider or shorter"};
  }
  const auto index = static_cast<std::uint32_t>(laid_.size());
  const float radius = ReachOf(stroke);
  float farthest = 0.0f;
  for (std::size_t i = 0; i < points.size() && pace->Ask(i); ++i) {
    const SurfacePoint place = surface_.Nearest(points[i]);
    farthest = std::max(farthest, glm::distance(points[i], place.position));
    points[i] = place.position;
    // Half a piece more, so that what is near the middle of a piece is found from its ends.
    const float reached = radius + 0.5f * PieceOf(stroke);
    for (const std::uint32_t t : reach->Find(place.position, {&place.triangle, 1}, reached)) {
      std::vector<std::uint32_t>& list = (*lists)[t];
      if (list.empty() || list.back() != index) list.push_back(index);
    }
  }
  if (farthest > std::max(kFarthest, kSteerWidths * stroke.width_mm * kMetres)) {
    return {StatusCode::kInvalidArgument,
            "the stroke lies " + std::to_string(std::lround(farthest / kMetres)) +
                " mm off the surface",
            NameOf(stroke), "points are metres in model space, on this character at rest"};
  }
  laid_.push_back({&stroke, paint::StrokeLine(std::move(points)), std::move(mask), radius});
  return {};
}

void StrokeLayer::MarkFolds(const SurfacePoint& point, std::vector<char>* seen) const {
  for (const std::uint32_t index : Near(point.triangle)) {
    const Laid& laid = laid_[index];
    if ((*seen)[index] || laid.stroke->kind != BakeStroke::Kind::kFold) continue;
    const float reach = paint::kStrokeReach * laid.stroke->width_mm * kMetres;
    const bool there = laid.line.FindNearest(point.position).distance < reach;
    (*seen)[index] = there && MaskAt(laid, point) > 0.0f;
  }
}

float StrokeLayer::MaskAt(const Laid& laid, const SurfacePoint& point) const {
  return laid.mask.empty() ? 1.0f : surface_.Interpolate(laid.mask, point);
}

StrokeLayer::Guidance StrokeLayer::GuidanceAt(const SurfacePoint& point) const {
  Guidance guidance;
  vec3 sum(0.0f);
  for (const std::uint32_t index : Near(point.triangle)) {
    const Laid& laid = laid_[index];
    const BakeStroke& stroke = *laid.stroke;
    const auto nearest = laid.line.FindNearest(point.position);
    const float weight = FalloffAt(nearest.distance, laid.reach).value * MaskAt(laid, point);
    if (weight <= 0.0f) continue;
    if (stroke.kind == BakeStroke::Kind::kExclude) {
      guidance.keep *= 1.0f - weight;
      continue;
    }
    const float length = glm::length(nearest.along);
    if (length > 1e-9f) {
      const vec3 along = nearest.along / length;
      sum += (glm::dot(along, sum) < 0.0f ? -weight : weight) * along;
    }
    if (stroke.kind == BakeStroke::Kind::kDirection && stroke.wavelength_mm > 0.0f) {
      guidance.wavelength += weight * stroke.wavelength_mm * kMetres;
      guidance.wavelength_share += weight;
    }
  }
  if (guidance.wavelength_share > 0.0f) {
    guidance.wavelength /= guidance.wavelength_share;
    guidance.wavelength_share = std::min(guidance.wavelength_share, 1.0f);
  }
  const float wanted = glm::length(sum);
  guidance.along = wanted > 1.0f ? sum / wanted : sum;
  return guidance;
}

StrokeLayer::Drawn StrokeLayer::At(const SurfacePoint& point, const vec3& tangent,
                                   const vec3& bitangent) const {
  Drawn drawn;
  for (const std::uint32_t index : Near(point.triangle)) {
    const Laid& laid = laid_[index];
    const BakeStroke& stroke = *laid.stroke;
    if (stroke.kind != BakeStroke::Kind::kFold) continue;
    const float width = stroke.width_mm * kMetres;
    const auto nearest = laid.line.FindNearest(point.position);
    if (nearest.distance >= paint::kStrokeReach * width) continue;
    const float strength = paint::StrokeTaper(nearest.place, stroke.taper) * MaskAt(laid, point);
    const vec2 away(glm::dot(nearest.away, tangent), glm::dot(nearest.away, bitangent));
    const paint::FoldShape shape = paint::FoldShapeAt(nearest.distance / width, stroke.ridge);
    const float depth = depth_ * stroke.depth_mm * kMetres * strength;
    drawn.fold.height += shape.height * depth;
    drawn.fold.slope += away * (shape.slope * depth / width);
    drawn.fold.cavity *= CavityOf(shape.height * depth, 2.0f * width);
    const Falloff cover = FalloffAt(nearest.distance, paint::kStrokeReach * width);
    const float keep = 1.0f - cover.value * strength;
    drawn.keep_slope = drawn.keep_slope * keep - away * (cover.slope * strength * drawn.keep);
    drawn.keep *= keep;
  }
  return drawn;
}

}  // namespace furrow::character::bake

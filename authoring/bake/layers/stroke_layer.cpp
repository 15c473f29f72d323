// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/layers/stroke_layer.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <glm/geometric.hpp>

#include "base/status.h"

namespace furrow::authoring {
namespace {

using glm::vec2;
using glm::vec3;

constexpr float kSteerWidths = 4.0f;  // strain folds follow a drawn fold within this many widths
constexpr float kFarthest = 0.02f;    // largest distance of a stroke from the surface, metres
constexpr std::size_t kMaxPoints = 200'000;

// 1 on the line, 0 from `reach` on, smooth at both ends.
struct Falloff {
  float value = 0.0f;
  float slope = 0.0f;  // derivative by the distance
};
Falloff FalloffAt(float distance, float reach) {
  const float x = distance / reach;
  if (x >= 1.0f) return {};
  const float q = 1.0f - x * x;
  return {q * q, -4.0f * x * q / reach};
}

// Distance between points on the line, metres.
float PieceOf(const BakeStroke& stroke) {
  return std::max(stroke.width_mm * kMetresPerMillimetre, 0.001f);
}

std::string NameOf(const BakeStroke& stroke) { return "stroke '" + stroke.name + "'"; }

// Points on the line that are close enough together for the straight segments between them to stay
// near the surface once the points are projected onto it.
std::vector<vec3> Densify(const BakeStroke& stroke) {
  std::vector<vec3> line = stroke.points;
  if (stroke.smooth) line = Smooth(stroke.points, 8);
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

// How far a stroke acts, metres. Folds also steer the strain folds beside them.
float ReachOf(const BakeStroke& stroke) {
  const float width = stroke.width_mm * kMetresPerMillimetre;
  return stroke.kind == BakeStroke::Kind::kFold ? kSteerWidths * width : width;
}

}  // namespace

float CavityOf(float height, float wavelength) {
  const float rise = 4.0f * std::max(-height, 0.0f) / std::max(wavelength, 1e-6f);
  return 1.0f / std::sqrt(1.0f + rise * rise);
}

Result<std::unique_ptr<StrokeLayer>> StrokeLayer::Create(
    const Surface& surface, const std::vector<const BakeStroke*>& strokes,
    std::vector<std::vector<float>> masks, float depth, BakeProgress* progress) {
  std::unique_ptr<StrokeLayer> layer(new StrokeLayer(surface, depth));
  SurfaceSearch reach(surface);
  std::vector<std::vector<std::uint32_t>> lists(surface.triangles().size());
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    if (!progress->Report(static_cast<float>(i) / static_cast<float>(strokes.size()))) break;
    FURROW_RETURN_IF_ERROR(
        layer->Place(*strokes[i], std::move(masks[i]), &reach, &lists, progress));
  }
  if (progress->cancelled()) return BakeProgress::CancelledStatus();
  layer->starts_.push_back(0);
  for (const auto& list : lists) {
    layer->lists_.insert(layer->lists_.end(), list.begin(), list.end());
    layer->starts_.push_back(layer->lists_.size());
  }
  return layer;
}

Status StrokeLayer::Place(const BakeStroke& stroke, std::vector<float> mask, SurfaceSearch* reach,
                          std::vector<std::vector<std::uint32_t>>* lists, BakeProgress* progress) {
  std::vector<vec3> points = Densify(stroke);
  num_points_ += points.size();
  if (num_points_ > kMaxPoints) {
    return {StatusCode::kLimit,
            "the strokes of one map have more than " + std::to_string(kMaxPoints) +
                " pieces (a piece is as long as its stroke is wide)",
            NameOf(stroke), "make strokes wider or shorter"};
  }
  const auto index = static_cast<std::uint32_t>(strokes_.size());
  const float radius = ReachOf(stroke);
  float farthest = 0.0f;
  for (std::size_t i = 0; i < points.size() && progress->RepeatReport(i); ++i) {
    const SurfacePoint place = surface_.Nearest(points[i]);
    farthest = std::max(farthest, glm::distance(points[i], place.position));
    points[i] = place.position;
    // Half a segment more, so that the middle of a segment is also found from its ends.
    const float reached = radius + 0.5f * PieceOf(stroke);
    for (const std::uint32_t t : reach->Find(place.position, {&place.triangle, 1}, reached)) {
      std::vector<std::uint32_t>& list = (*lists)[t];
      // Strokes are placed one after another, so comparing with the last entry lists each once.
      if (list.empty() || list.back() != index) list.push_back(index);
    }
  }
  // Points in the wrong unit or space would otherwise bake onto some distant triangle.
  if (farthest > std::max(kFarthest, kSteerWidths * stroke.width_mm * kMetresPerMillimetre)) {
    return {StatusCode::kInvalidArgument,
            "the stroke lies " + std::to_string(std::lround(farthest / kMetresPerMillimetre)) +
                " mm away from the surface",
            NameOf(stroke), "give points in metres, in model space, on the character at rest"};
  }
  strokes_.push_back({&stroke, StrokeLine(std::move(points)), std::move(mask), radius});
  return {};
}

// For statistics: which fold strokes touch at least one texel of this map.
void StrokeLayer::MarkFolds(const SurfacePoint& point, std::vector<char>* seen) const {
  for (const std::uint32_t index : Near(point.triangle)) {
    const PlacedStroke& placed = strokes_[index];
    if ((*seen)[index] || placed.stroke->kind != BakeStroke::Kind::kFold) continue;
    const float reach = kStrokeReach * placed.stroke->width_mm * kMetresPerMillimetre;
    const bool there = placed.line.FindNearest(point.position).distance < reach;
    (*seen)[index] = there && MaskAt(placed, point) > 0.0f;
  }
}

float StrokeLayer::MaskAt(const PlacedStroke& placed, const SurfacePoint& point) const {
  return placed.mask.empty() ? 1.0f : surface_.Interpolate(placed.mask, point);
}

StrokeLayer::Guidance StrokeLayer::GuidanceAt(const SurfacePoint& point) const {
  Guidance guidance;
  vec3 sum(0.0f);
  for (const std::uint32_t index : Near(point.triangle)) {
    const PlacedStroke& placed = strokes_[index];
    const BakeStroke& stroke = *placed.stroke;
    const auto nearest = placed.line.FindNearest(point.position);
    const float weight = FalloffAt(nearest.distance, placed.reach).value * MaskAt(placed, point);
    if (weight <= 0.0f) continue;
    if (stroke.kind == BakeStroke::Kind::kExclude) {
      guidance.keep *= 1.0f - weight;
      continue;
    }
    const float length = glm::length(nearest.along);
    if (length > 1e-9f) {
      const vec3 along = nearest.along / length;
      // A line has no sign: add whichever direction agrees with the sum so far.
      sum += (glm::dot(along, sum) < 0.0f ? -weight : weight) * along;
    }
    if (stroke.kind == BakeStroke::Kind::kDirection && stroke.wavelength_mm > 0.0f) {
      guidance.wavelength += weight * stroke.wavelength_mm * kMetresPerMillimetre;
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

StrokeLayer::Sample StrokeLayer::At(const SurfacePoint& point, const vec3& tangent,
                                    const vec3& bitangent) const {
  Sample drawn;
  for (const std::uint32_t index : Near(point.triangle)) {
    const PlacedStroke& placed = strokes_[index];
    const BakeStroke& stroke = *placed.stroke;
    if (stroke.kind != BakeStroke::Kind::kFold) continue;
    const float width = stroke.width_mm * kMetresPerMillimetre;
    const auto nearest = placed.line.FindNearest(point.position);
    if (nearest.distance >= kStrokeReach * width) continue;
    const float strength = StrokeTaper(nearest.place, stroke.taper) * MaskAt(placed, point);
    const vec2 away(glm::dot(nearest.away, tangent), glm::dot(nearest.away, bitangent));
    const FoldShape shape = FoldShapeAt(nearest.distance / width, stroke.ridge);
    const float depth = depth_ * stroke.depth_mm * kMetresPerMillimetre * strength;
    drawn.fold.height += shape.height * depth;
    drawn.fold.slope += away * (shape.slope * depth / width);
    drawn.fold.cavity *= CavityOf(shape.height * depth, 2.0f * width);
    const Falloff cover = FalloffAt(nearest.distance, kStrokeReach * width);
    const float keep = 1.0f - cover.value * strength;
    // Several strokes multiply; this is the product rule.
    drawn.keep_slope = drawn.keep_slope * keep - away * (cover.slope * strength * drawn.keep);
    drawn.keep *= keep;
  }
  return drawn;
}

}  // namespace furrow::authoring

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "authoring/bake/request/bake_progress.h"
#include "authoring/bake/request/bake_request.h"
#include "authoring/bake/surface/surface.h"
#include "authoring/paint/strokes.h"

namespace furrow::authoring {

// The folds at one point: height above the rest surface in metres, its slope along tangent and
// bitangent, and how open the point is to the sky.
struct FoldSample {
  float height = 0.0f;
  glm::vec2 slope{0.0f};  // dh/d(tangent), dh/d(bitangent)
  float cavity = 1.0f;
};

// How open a valley is to the sky: the cosine of the angle of its walls. `height`: metres,
// negative; `wavelength`: metres.
[[nodiscard]] float CavityOf(float height, float wavelength);

// The strokes of one map, projected onto a surface. A stroke affects only what is within reach over
// the surface, so it does not leak from one lip or finger to the next.
class StrokeLayer {
 public:
  // `surface` and `strokes` must outlive the layer. `masks`: one per stroke, its strength at each
  // welded vertex, [0, 1]; empty: 1 everywhere. `depth` scales heights.
  // Errors: kInvalidArgument (a stroke more than 20 mm and four widths from the surface), kLimit
  // (strokes too long for their widths), kUnavailable (cancelled).
  [[nodiscard]] static Result<std::unique_ptr<StrokeLayer>> Create(
      const Surface& surface, const std::vector<const BakeStroke*>& strokes,
      std::vector<std::vector<float>> masks, float depth, BakeProgress* progress);

  // How strokes change the folds from strain at a point.
  struct Guidance {
    glm::vec3 along{0.0f};    // direction for the folds; the length is its strength, [0, 1]
    float keep = 1.0f;        // factor of the folds' height, [0, 1]
    float wavelength = 0.0f;  // metres, valid if the share below is positive
    float wavelength_share = 0.0f;
  };
  [[nodiscard]] Guidance GuidanceAt(const SurfacePoint& point) const;

  // The folds that strokes draw, and the factor that remains of the folds from strain.
  struct Sample {
    FoldSample fold;
    float keep = 1.0f;
    glm::vec2 keep_slope{0.0f};
  };
  [[nodiscard]] Sample At(const SurfacePoint& point, const glm::vec3& tangent,
                          const glm::vec3& bitangent) const;

  // Marks the fold strokes that affect a point. `seen`: one entry per stroke.
  void MarkFolds(const SurfacePoint& point, std::vector<char>* seen) const;
  [[nodiscard]] std::size_t num_strokes() const { return strokes_.size(); }

 private:
  struct PlacedStroke {
    const BakeStroke* stroke;
    StrokeLine line;
    std::vector<float> mask;
    float reach;  // metres from the line
  };

  StrokeLayer(const Surface& surface, float depth) : surface_(surface), depth_(depth) {}
  Status Place(const BakeStroke& stroke, std::vector<float> mask, SurfaceSearch* reach,
               std::vector<std::vector<std::uint32_t>>* lists, BakeProgress* progress);
  [[nodiscard]] std::span<const std::uint32_t> Near(std::uint32_t triangle) const {
    return std::span(lists_).subspan(starts_[triangle], starts_[triangle + 1] - starts_[triangle]);
  }
  [[nodiscard]] float MaskAt(const PlacedStroke& placed, const SurfacePoint& point) const;

  const Surface& surface_;
  float depth_;
  std::size_t num_points_ = 0;
  std::vector<PlacedStroke> strokes_;
  std::vector<std::uint32_t> lists_;  // strokes that reach each triangle, concatenated
  std::vector<std::size_t> starts_;
};

}  // namespace furrow::authoring

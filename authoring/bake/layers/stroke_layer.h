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

// The folds at one point of a surface.
struct FoldSample {
  float height = 0.0f;    // above the rest surface, metres; negative in a valley
  glm::vec2 slope{0.0f};  // dh/d(tangent), dh/d(bitangent)
  float cavity = 1.0f;    // how open the point is to the sky, 0 closed to 1 open
};

// How open a valley is to the sky, (0, 1]: the cosine of the angle of its walls. `height`: of the
// valley, metres, negative. `wavelength`: metres.
[[nodiscard]] float CavityOf(float height, float wavelength);

// The strokes of one map, projected onto a surface. Distances from a stroke are measured over the
// surface, so a stroke does not leak from one lip or finger to the next.
class StrokeLayer {
 public:
  // `surface` and `strokes` must outlive the layer. `masks`: for each stroke, its strength at each
  // welded vertex, [0, 1]; an empty list means 1 everywhere. `depth`: multiplier for heights.
  // Errors: kInvalidArgument (a stroke more than 20 mm and four widths from the surface), kLimit
  // (strokes too long for their widths), kUnavailable (cancelled).
  [[nodiscard]] static Result<std::unique_ptr<StrokeLayer>> Create(
      const Surface& surface, const std::vector<const BakeStroke*>& strokes,
      std::vector<std::vector<float>> masks, float depth, BakeProgress* progress);

  // How strokes change the folds from strain at a point.
  struct Guidance {
    glm::vec3 along{0.0f};          // direction for the folds; the length is its strength, [0, 1]
    float keep = 1.0f;              // multiplier for the height of the folds, [0, 1]
    float wavelength = 0.0f;        // metres; valid if `wavelength_share` > 0
    float wavelength_share = 0.0f;  // 0 the wavelength of the material to 1 `wavelength`
  };
  [[nodiscard]] Guidance GuidanceAt(const SurfacePoint& point) const;

  // The folds that strokes draw at a point, and their effect on the folds from strain.
  struct Sample {
    FoldSample fold;
    float keep = 1.0f;           // multiplier for the folds from strain, [0, 1]
    glm::vec2 keep_slope{0.0f};  // derivative of `keep` along tangent and bitangent, per metre
  };
  [[nodiscard]] Sample At(const SurfacePoint& point, const glm::vec3& tangent,
                          const glm::vec3& bitangent) const;

  // Sets the entries of `seen` (one per stroke) to 1 for fold strokes that affect a point; leaves
  // the others unchanged.
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

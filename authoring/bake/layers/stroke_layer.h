// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "authoring/bake/bake.h"
#include "authoring/bake/pace.h"
#include "authoring/bake/surface/surface.h"
#include "authoring/paint/strokes.h"

namespace furrow::character::bake {

// What is made of one place: height over the rest surface in metres, its derivative along the
// tangent and the bitangent, and how open it is to the sky.
struct FoldSample {
  float height = 0.0f;
  glm::vec2 slope{0.0f};  // dh/d(tangent), dh/d(bitangent)
  float cavity = 1.0f;
};

// How open a valley of `height` (metres, below 0) in folds of `wavelength` is: the cosine of the
// angle that its walls rise at.
[[nodiscard]] float CavityOf(float height, float wavelength);

// The painted strokes of one map, laid onto a surface. They reach no further than they can be
// walked to over it.
class StrokeLayer {
 public:
  // `surface` and `strokes` outlive the layer. `masks`: one a stroke, how much of it counts at each
  // welded vertex; an empty one: everywhere all of it. `depth` scales heights.
  // kInvalidArgument: a stroke that lies further off the surface than 20 mm and four widths.
  // kLimit: strokes too long for their widths. kUnavailable: stopped.
  [[nodiscard]] static Result<std::unique_ptr<StrokeLayer>> Create(
      const Surface& surface, const std::vector<const BakeStroke*>& strokes,
      std::vector<std::vector<float>> masks, float depth, Pace* pace);

  // What strokes leave of the folds of strain at a place.
  struct Guidance {
    glm::vec3 along{0.0f};    // the way folds should run, as long as it is wanted, [0, 1]
    float keep = 1.0f;        // of their height, [0, 1]
    float wavelength = 0.0f;  // metres, with the weight below; 0: none asked for
    float wavelength_share = 0.0f;
  };
  [[nodiscard]] Guidance GuidanceAt(const SurfacePoint& point) const;

  // Folds that are drawn, and by how much they displace those of strain.
  struct Drawn {
    FoldSample fold;
    float keep = 1.0f;
    glm::vec2 keep_slope{0.0f};
  };
  [[nodiscard]] Drawn At(const SurfacePoint& point, const glm::vec3& tangent,
                         const glm::vec3& bitangent) const;

  // Notes the fold strokes that are something at a place: `seen` has one entry a stroke.
  void MarkFolds(const SurfacePoint& point, std::vector<char>* seen) const;
  [[nodiscard]] std::size_t num_strokes() const { return laid_.size(); }

 private:
  struct Laid {
    const BakeStroke* stroke;
    paint::StrokeLine line;
    std::vector<float> mask;
    float reach;  // metres from the line
  };

  StrokeLayer(const Surface& surface, float depth) : surface_(surface), depth_(depth) {}
  Status Lay(const BakeStroke& stroke, std::vector<float> mask, SurfaceReach* reach,
             std::vector<std::vector<std::uint32_t>>* lists, Pace* pace);
  [[nodiscard]] std::span<const std::uint32_t> Near(std::uint32_t triangle) const {
    return std::span(lists_).subspan(starts_[triangle], starts_[triangle + 1] - starts_[triangle]);
  }
  [[nodiscard]] float MaskAt(const Laid& laid, const SurfacePoint& point) const;

  const Surface& surface_;
  float depth_;
  std::size_t num_points_ = 0;
  std::vector<Laid> laid_;
  std::vector<std::uint32_t> lists_;  // strokes near each triangle
  std::vector<std::size_t> starts_;
};

}  // namespace furrow::character::bake

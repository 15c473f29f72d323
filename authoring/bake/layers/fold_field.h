// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "authoring/bake/layers/stroke_layer.h"
#include "authoring/bake/surface/surface.h"

namespace furrow::character::bake {

// What a place of a surface asks of its folds.
struct FoldDemand {
  glm::vec3 across{1.0f, 0.0f, 0.0f};  // unit, in the surface: the strongest compression
  glm::vec3 along{0.0f, 1.0f, 0.0f};   // unit: the way folds run
  float compression = 0.0f;            // along `across`
  float crossing = 0.0f;               // along `along`, at most as much
  float wavelength = 0.005f;           // metres
  float smallest = 0.0f;               // wavelength that the map's texels can show here
};

// The compression of a map's poses and the guidance of its strokes, as one field over the surface.
class FoldField {
 public:
  // `tensors`: compression, one a welded vertex, in its axes. `wavelengths`: metres, one a welded
  // vertex; `smallest`: what texels can show, likewise. `surface` and `strokes` outlive the field.
  FoldField(const Surface& surface, const StrokeLayer& strokes, std::vector<Tensor2> tensors,
            std::vector<float> wavelengths, std::vector<float> smallest);

  [[nodiscard]] FoldDemand At(const SurfacePoint& point) const;
  // The strongest compression of the triangle's vertices, and across it.
  [[nodiscard]] float Strongest(std::uint32_t triangle, bool crossing) const;
  // The wavelength, scaled, as far as it can be shown.
  [[nodiscard]] float Wavelength(const SurfacePoint& point, float scale) const {
    return std::max(scale * surface_.Interpolate(wavelengths_, point),
                    surface_.Interpolate(smallest_, point));
  }
  [[nodiscard]] const Surface& surface() const { return surface_; }
  [[nodiscard]] const StrokeLayer& strokes() const { return strokes_; }

 private:
  const Surface& surface_;
  const StrokeLayer& strokes_;
  std::vector<Tensor2> tensors_;
  std::vector<float> wavelengths_;
  std::vector<float> smallest_;
};

}  // namespace furrow::character::bake

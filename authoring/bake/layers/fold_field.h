// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "authoring/bake/layers/stroke_layer.h"
#include "authoring/bake/surface/surface.h"

namespace furrow::authoring {

// The parameters of the folds at one point of a surface.
struct FoldParameters {
  glm::vec3 across{1.0f, 0.0f,
                   0.0f};  // direction of strongest compression; unit vector in the surface
  glm::vec3 along{0.0f, 1.0f, 0.0f};  // direction that folds run in; unit vector in the surface
  float compression = 0.0f;           // along `across`: 0 none, 1 to length zero
  float crossing = 0.0f;              // compression along `along`, at most `compression`
  float wavelength = 0.005f;          // metres
  float smallest = 0.0f;  // the shortest wavelength that the map's texels can show here, metres
};

// Combines the compression of a map's poses with the guidance of its strokes.
class FoldField {
 public:
  // Per welded vertex: `tensors`, the compression in the vertex's axes; `wavelengths`, metres;
  // `smallest`, the shortest wavelength that texels can show, metres. `surface` and `strokes` must
  // outlive the field.
  FoldField(const Surface& surface, const StrokeLayer& strokes, std::vector<Tensor2> tensors,
            std::vector<float> wavelengths, std::vector<float> smallest);

  // The parameters at a point, interpolated from the vertices and changed by the strokes.
  [[nodiscard]] FoldParameters At(const SurfacePoint& point) const;
  // The strongest compression at the triangle's three vertices, [0, 1]. With `crossing`: the
  // strongest compression perpendicular to it.
  [[nodiscard]] float Strongest(std::uint32_t triangle, bool crossing) const;
  // The wavelength times `scale`, but not below what texels can show. Metres.
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

}  // namespace furrow::authoring

// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/layers/fold_field.h"

#include <algorithm>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "authoring/bake/surface/compression.h"

namespace furrow::authoring {
namespace {

using glm::vec2;
using glm::vec3;

// Rotates the compression so that folds run along `along` (in the tensor's axes). The length of
// `along`, [0, 1], is the strength of the rotation.
Tensor2 Steer(const Tensor2& tensor, const vec2& along) {
  const float wanted = glm::length(along);
  if (wanted < 1e-4f) return tensor;
  const vec2 across = vec2(-along.y, along.x) / wanted;
  const Principal2 principal = PrincipalOf(tensor);
  const float large = principal.large, small = principal.small;
  const Tensor2 turned{large * across.x * across.x + small * across.y * across.y,
                       (large - small) * across.x * across.y,
                       large * across.y * across.y + small * across.x * across.x};
  return (1.0f - wanted) * tensor + wanted * turned;
}

}  // namespace

FoldField::FoldField(const Surface& surface, const StrokeLayer& strokes,
                     std::vector<Tensor2> tensors, std::vector<float> wavelengths,
                     std::vector<float> smallest)
    : surface_(surface),
      strokes_(strokes),
      tensors_(std::move(tensors)),
      wavelengths_(std::move(wavelengths)),
      smallest_(std::move(smallest)) {}

// Everything at one point is in the axes of the point's triangle: the tensors are carried there,
// and the guidance is projected.
FoldParameters FoldField::At(const SurfacePoint& point) const {
  const wrinkle::SurfaceAxes& axes = surface_.triangles()[point.triangle].axes;
  const StrokeLayer::Guidance guidance = strokes_.GuidanceAt(point);
  const vec2 along(glm::dot(guidance.along, axes.x), glm::dot(guidance.along, axes.y));
  const Principal2 principal = PrincipalOf(Steer(surface_.Interpolate(tensors_, point), along));
  FoldParameters fold;
  fold.across = axes.x * principal.direction.x + axes.y * principal.direction.y;
  fold.along = glm::cross(axes.normal, fold.across);
  fold.compression = guidance.keep * std::max(principal.large, 0.0f);
  fold.crossing = guidance.keep * std::max(principal.small, 0.0f);
  fold.wavelength = glm::mix(surface_.Interpolate(wavelengths_, point), guidance.wavelength,
                             guidance.wavelength_share);
  fold.smallest = surface_.Interpolate(smallest_, point);
  return fold;
}

// For the larger compression this is a bound: an interpolated tensor is never stronger than the
// strongest at the corners.
float FoldField::Strongest(std::uint32_t triangle, bool crossing) const {
  float strongest = 0.0f;
  for (const std::uint32_t vertex : surface_.triangles()[triangle].vertices) {
    const Principal2 principal = PrincipalOf(tensors_[vertex]);
    strongest = std::max(strongest, crossing ? principal.small : principal.large);
  }
  return strongest;
}

}  // namespace furrow::authoring

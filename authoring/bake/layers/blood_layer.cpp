// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/layers/blood_layer.h"

#include <cstddef>
#include <cstdint>
#include <span>

#include "authoring/bake/layers/blood.h"
#include "authoring/bake/request/bake_request.h"

namespace furrow::authoring {
namespace {

// The share of blood that furrows press into the skin around each vertex: the mean of what they
// lose there, weighted by area and barycentric coordinates. The weights of a point sum to 1, so
// interpolation gives back exactly what the furrows lost.
std::vector<float> BloodBeside(const BakeSurface& baked, std::span<const float> arms,
                               const BakedMap& map) {
  const Surface& surface = baked.surface();
  std::vector<double> sums(surface.positions().size()), areas(sums.size());
  for (const SurfaceTexel& texel : baked.texels()) {
    const SurfacePoint place = PlaceOf(texel);
    const float side = surface.Interpolate(baked.texel_metres(), place);
    const float lost =
        PressedOut(surface.Interpolate(arms, place), map.cavity[map.IndexOf(texel.x, texel.y)]);
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t vertex =
          surface.triangles()[texel.triangle].vertices[static_cast<std::size_t>(k)];
      const auto area = static_cast<double>(side * side * texel.corners[k]);
      sums[vertex] += area * static_cast<double>(lost);
      areas[vertex] += area;
    }
  }
  std::vector<float> beside;
  beside.reserve(sums.size());
  for (std::size_t v = 0; v < sums.size(); ++v) {
    beside.push_back(areas[v] > 0.0 ? static_cast<float>(sums[v] / areas[v]) : 0.0f);
  }
  return beside;
}

}  // namespace

void FillBlood(const BakeSurface& surface, const BloodFields& fields, BakedMap* map) {
  const std::vector<float> beside = BloodBeside(surface, fields.arms, *map);
  map->blood.assign(map->cavity.size(), 1.0f);
  for (const SurfaceTexel& texel : surface.texels()) {
    const std::size_t at = map->IndexOf(texel.x, texel.y);
    const auto here = [&](std::span<const float> values) {
      return surface.surface().Interpolate(values, PlaceOf(texel));
    };
    const float arm = here(fields.arms);
    const float moved = here(beside) - PressedOut(arm, map->cavity[at]);
    const float stretch =
        RidgeStretch(arm, map->height_mm[at], here(fields.wavelengths) / kMetresPerMillimetre);
    const float change = here(fields.blood) * (1.0f + moved) / (1.0f + stretch) - 1.0f;
    map->blood[at] = 1.0f + here(fields.amounts) * change;
  }
}

}  // namespace furrow::authoring

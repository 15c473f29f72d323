// SPDX-License-Identifier: Apache-2.0
#include "render/passes/picture_cost.h"

#include <algorithm>

#include "render/scene/lighting.h"

namespace furrow::render {
namespace {

// Bytes per pixel of the targets with one sample, at the pass that needs most of them (AddFacets()
// and AddLightPass() in the skin pipeline; measured by FrameGraph::PeakBytes()).
constexpr std::size_t kPixelBytes = 60;
// Bytes per sample of the multisampled targets (ScenePass::AddSkin()).
constexpr std::size_t kSampleBytes = 36;
constexpr std::size_t kShadowTexelBytes = 4;
// Posing and drawing the meshes costs about as much as shading this many pixels.
constexpr double kGeometryWork = 50'000.0;
// A view of the strip draws all meshes again, into a picture of 1/36 of the size.
constexpr double kStripShare = 1.0 / 36.0;

}  // namespace

PictureCost EstimateCost(const Settings& settings, int width, int height, int samples) {
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  const int chosen = settings.anti_aliasing.samples;
  const auto n = static_cast<std::size_t>(std::max(1, chosen == 0 ? samples : chosen));
  const auto views = static_cast<double>(settings.strip.views.size());
  PictureCost cost;
  cost.texture_bytes = pixels * (kPixelBytes + (n > 1 ? n * kSampleBytes : 0));
  if (settings.shadow.filter != ShadowFilter::kOff && settings.shadow.lamps > 0) {
    const auto side = static_cast<std::size_t>(settings.shadow.resolution);
    cost.texture_bytes += side * side * kNumLights * kShadowTexelBytes;
  }
  cost.work =
      static_cast<double>(pixels * n) * (1.0 + views * kStripShare) + kGeometryWork * (1.0 + views);
  return cost;
}

}  // namespace furrow::render

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/passes/fullscreen.h"
#include "render/settings.h"

namespace furrow::render {

// What the subsurface passes know of the picture's geometry.
struct SkinGeometry {
  int width = 0;  // pixels
  int height = 0;
  float focus_distance = 1.0f;  // metres; depths in the irradiance's alpha count from it
  float pixels_per_mm = 1.0f;   // there
  ScreenRect bounds;            // all skin lies within
};

// Lets the light on skin scatter. `irradiance`: rgb: light, a: metres behind the focus, 60000 where
// there is no skin. Returns light in the same layout; `irradiance` itself where nothing scatters.
class SubsurfacePass {
 public:
  explicit SubsurfacePass(Fullscreen* fullscreen) : fullscreen_(fullscreen) {}

  [[nodiscard]] FrameGraph::Handle Add(FrameGraph* graph, FrameGraph::Handle irradiance,
                                       const SubsurfaceSettings& settings,
                                       const SkinGeometry& geometry);

 private:
  [[nodiscard]] FrameGraph::Handle AddSeparable(FrameGraph* graph, FrameGraph::Handle irradiance,
                                                const SubsurfaceSettings& settings,
                                                const SkinGeometry& geometry);

  Fullscreen* fullscreen_;
};

}  // namespace furrow::render

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/passes/fullscreen.h"
#include "render/settings/settings.h"
#include "render/skin/pixel_kernel.h"

namespace furrow::render {

// What the subsurface passes know of the picture's geometry.
struct SkinGeometry {
  int width = 0;  // pixels
  int height = 0;
  float focus_distance = 1.0f;   // metres; depths in the irradiance's alpha count from it
  float pixels_per_mm = 1.0f;    // there
  ScreenRect bounds;             // all skin lies within
  FrameGraph::Handle surface_z;  // of FullscreenPass
};

// Lets the light on skin scatter. `irradiance`: rgb: light, a: metres behind the focus, 60000 where
// there is no skin. Returns light in the same layout; `irradiance` itself where nothing scatters.
//
// - gaussians: the thesis' six blurs, one after the other, each along x and y, and their sum.
// - separable: one kernel along x and y. burley: one disc of taps.
// - preintegrated has happened in the scene pass.
class SubsurfacePass {
 public:
  explicit SubsurfacePass(Fullscreen* fullscreen) : fullscreen_(fullscreen) {}

  [[nodiscard]] FrameGraph::Handle Add(FrameGraph* graph, FrameGraph::Handle irradiance,
                                       const SubsurfaceSettings& settings,
                                       const SkinGeometry& geometry);

 private:
  // What a pass along one axis is.
  struct AxisPass {
    const char* name;
    const char* target;
    int axis = 0;
    float strength = 1.0f;
  };
  [[nodiscard]] FrameGraph::Handle AddAxis(FrameGraph* graph, const AxisPass& what,
                                           FrameGraph::Handle in, FrameGraph::Handle unscattered,
                                           const PixelTaps& taps,
                                           const SubsurfaceSettings& settings,
                                           const SkinGeometry& geometry);
  [[nodiscard]] FrameGraph::Handle AddSeparable(FrameGraph* graph, FrameGraph::Handle irradiance,
                                                const SubsurfaceSettings& settings,
                                                const SkinGeometry& geometry);
  [[nodiscard]] FrameGraph::Handle AddGaussians(FrameGraph* graph, FrameGraph::Handle irradiance,
                                                const SubsurfaceSettings& settings,
                                                const SkinGeometry& geometry);
  [[nodiscard]] FrameGraph::Handle AddBurley(FrameGraph* graph, FrameGraph::Handle irradiance,
                                             const SubsurfaceSettings& settings,
                                             const SkinGeometry& geometry);
  void DrawSkin(const SkinGeometry& geometry);  // of a pass that runs; no skin elsewhere

  Fullscreen* fullscreen_;
};

}  // namespace furrow::render

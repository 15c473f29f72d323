// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/passes/fullscreen.h"
#include "render/settings/settings.h"
#include "render/skin/pixel_kernel.h"

namespace furrow::render {

// The picture's geometry for the subsurface passes.
struct SkinGeometry {
  int width = 0;  // pixels
  int height = 0;
  float focus_distance = 1.0f;   // metres from the camera to its target
  float pixels_per_mm = 1.0f;    // pixels per millimetre of a surface at the focus distance
  ScreenRect bounds;             // pixels outside show no skin
  FrameGraph::Handle surface_z;  // FullscreenPass::surface_z
};

// Scatters the light on skin in screen space. SubsurfaceSettings::method chooses how:
//
// - gaussians: the thesis' six consecutive blurs, each along x and y, and their weighted sum.
// - separable: one kernel along x and y. burley: one disc of taps.
// - preintegrated and off: nothing; the lighting applies preintegrated scattering.
class SubsurfacePass {
 public:
  // `fullscreen` must outlive the pass.
  explicit SubsurfacePass(Fullscreen* fullscreen) : fullscreen_(fullscreen) {}
  // Returns the scattered light, or `irradiance` itself if nothing scatters here. Both hold linear
  // light in rgb and, in alpha, metres behind the focus, or kFarAway where there is no skin.

  [[nodiscard]] FrameGraph::Handle Add(FrameGraph* graph, FrameGraph::Handle irradiance,
                                       const SubsurfaceSettings& settings,
                                       const SkinGeometry& geometry);

 private:
  // A pass along one axis.
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
  void DrawSkin(const SkinGeometry& geometry);  // call only while a pass runs; draws nothing
                                                // outside the skin

  Fullscreen* fullscreen_;
};

}  // namespace furrow::render

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat3x3.hpp>

#include "render/passes/fullscreen.h"
#include "render/passes/scene_pass.h"
#include "render/settings/settings.h"

namespace furrow::render {

// The camera's geometry for ambient occlusion.
struct OcclusionGeometry {
  int width = 0;  // pixels
  int height = 0;
  glm::mat3 view_rotation{1.0f};  // model space to view space
  float pixels_per_slope = 1.0f;  // height / 2 * cot(fov / 2)
  ScreenRect bounds;              // contains all surfaces
  glm::vec3 background{0.0f};     // radiance outside the surfaces
};

// Ambient occlusion: how much of the sky each pixel sees, and how much of the sky's light remains.
class OcclusionPass {
 public:
  explicit OcclusionPass(Fullscreen* fullscreen) : fullscreen_(fullscreen) {}

  struct Openness {
    FrameGraph::Handle target;  // [0, 1] in red; no handle if the method is off
    int scale = 1;              // scene pixels per target pixel, along each axis
  };
  // Computes the openness of surfaces from their depth (metres along the camera's axis) and
  // normals.
  [[nodiscard]] Openness Add(FrameGraph* graph, FrameGraph::Handle depth, FrameGraph::Handle normal,
                             const OcclusionSettings& settings, const OcclusionGeometry& geometry);
  // Removes the occluded part of the sky's light from irradiance and radiance that are already lit.
  [[nodiscard]] SkinTargets AddOcclude(FrameGraph* graph, const SkinTargets& lit,
                                       const Openness& open, const OcclusionSettings& settings,
                                       const OcclusionGeometry& geometry);
  // Largest depth difference in metres between pixels that share their openness in the blur.
  [[nodiscard]] static float RangeOf(const OcclusionSettings& settings);

 private:
  [[nodiscard]] FrameGraph::Handle AddSearch(FrameGraph* graph, FrameGraph::Handle depth,
                                             FrameGraph::Handle normal,
                                             const OcclusionSettings& settings,
                                             const OcclusionGeometry& geometry);
  [[nodiscard]] FrameGraph::Handle AddBlur(FrameGraph* graph, FrameGraph::Handle open,
                                           FrameGraph::Handle depth,
                                           const OcclusionSettings& settings,
                                           const OcclusionGeometry& geometry);
  // Call only while a pass runs. Draws the part that the character may cover and marks the rest as
  // open.
  void DrawBounds(const OcclusionSettings& settings, const OcclusionGeometry& geometry);

  Fullscreen* fullscreen_;
};

}  // namespace furrow::render

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat3x3.hpp>

#include "render/passes/fullscreen.h"
#include "render/passes/scene_pass.h"
#include "render/settings/settings.h"

namespace furrow::render {

// What ambient occlusion knows of the camera.
struct OcclusionGeometry {
  int width = 0;  // pixels
  int height = 0;
  glm::mat3 view_rotation{1.0f};  // model space to the camera's
  float pixels_per_slope = 1.0f;  // H/2 cot(fov/2)
  ScreenRect bounds;              // all surfaces lie within
  glm::vec3 background{0.0f};     // light beyond them
};

// Ambient occlusion: how much of the sky each pixel sees, and what that leaves of its light.
class OcclusionPass {
 public:
  explicit OcclusionPass(Fullscreen* fullscreen) : fullscreen_(fullscreen) {}

  struct Openness {
    FrameGraph::Handle target;  // [0, 1] in red; none where the method is off
    int scale = 1;              // pixels of the scene to one of the target's, along each axis
  };
  // Of surfaces given by their depth (metres along the camera's axis) and normals.
  [[nodiscard]] Openness Add(FrameGraph* graph, FrameGraph::Handle depth, FrameGraph::Handle normal,
                             const OcclusionSettings& settings, const OcclusionGeometry& geometry);
  // Takes from irradiance and radiance that are lit already the light of the sky, by its share.
  [[nodiscard]] SkinTargets AddOcclude(FrameGraph* graph, const SkinTargets& lit,
                                       const Openness& open, const OcclusionSettings& settings,
                                       const OcclusionGeometry& geometry);
  // Metres of depth within which surfaces lend each other their openness.
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
  // Of a pass that runs: where the character can be; all is open elsewhere.
  void DrawBounds(const OcclusionSettings& settings, const OcclusionGeometry& geometry);

  Fullscreen* fullscreen_;
};

}  // namespace furrow::render

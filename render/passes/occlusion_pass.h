// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>

#include "render/passes/fullscreen.h"
#include "render/passes/scene_pass.h"
#include "render/settings/settings.h"

namespace furrow::render {

// The camera's geometry for ambient occlusion.
struct OcclusionGeometry {
  int width = 0;  // pixels of the scene
  int height = 0;
  glm::mat3 view_rotation{1.0f};  // model space to view space, in which the camera looks along -Z
  // Pixels per unit of x / z or y / z in view space: height / 2 * cot(vertical field of view / 2).
  float pixels_per_slope = 1.0f;
  ScreenRect bounds;           // pixels outside show no surface; they are not computed
  glm::vec3 background{0.0f};  // linear radiance of pixels without a surface
  glm::vec2 jitter{0.0f};      // by which the scene is moved, pixels

  // The pixel on the camera's axis.
  [[nodiscard]] glm::vec2 axis() const {
    return 0.5f * glm::vec2(static_cast<float>(width), static_cast<float>(height)) + jitter;
  }
};

// Ambient occlusion: computes how much of the sky each pixel sees, and removes the rest of the
// sky's light.
class OcclusionPass {
 public:
  // `fullscreen` must outlive the pass.
  explicit OcclusionPass(Fullscreen* fullscreen) : fullscreen_(fullscreen) {}

  // The share of the sky that each pixel sees.
  struct Openness {
    // In red: 0, all of the sky is hidden, to 1, all of it is visible. An empty handle if occlusion
    // is off.
    FrameGraph::Handle target;
    int scale = 1;  // scene pixels per target pixel, along each axis: 1 or 2
  };
  // Returns the openness of surfaces, blurred. `depth`: metres along the camera's axis. `normal`:
  // unit, model space.
  [[nodiscard]] Openness Add(FrameGraph* graph, FrameGraph::Handle depth, FrameGraph::Handle normal,
                             const OcclusionSettings& settings, const OcclusionGeometry& geometry);
  // Returns `lit` with new irradiance and radiance, from which the hidden part of the sky's light
  // is removed. Returns `lit` itself if `open` is empty. `open`: the result of Add().
  [[nodiscard]] SkinTargets AddOcclude(FrameGraph* graph, const SkinTargets& lit,
                                       const Openness& open, const OcclusionSettings& settings,
                                       const OcclusionGeometry& geometry);
  // The blur's depth limit in metres: pixels whose depths differ by more do not mix their openness.
  [[nodiscard]] static float BlurDepthLimit(const OcclusionSettings& settings);

 private:
  [[nodiscard]] FrameGraph::Handle AddSearch(FrameGraph* graph, FrameGraph::Handle depth,
                                             FrameGraph::Handle normal,
                                             const OcclusionSettings& settings,
                                             const OcclusionGeometry& geometry);
  [[nodiscard]] FrameGraph::Handle AddBlur(FrameGraph* graph, FrameGraph::Handle open,
                                           FrameGraph::Handle depth,
                                           const OcclusionSettings& settings,
                                           const OcclusionGeometry& geometry);
  // Call only while a pass runs. Draws the pixels of geometry.bounds and sets the others to 1
  // (open).
  void DrawBounds(const OcclusionSettings& settings, const OcclusionGeometry& geometry);

  Fullscreen* fullscreen_;
};

}  // namespace furrow::render

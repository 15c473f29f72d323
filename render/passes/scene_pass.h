// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/gl/gl_device.h"
#include "render/graph/frame_graph.h"
#include "render/passes/scene_draw.h"

namespace furrow::render {

// The skin pipeline's scene targets. See shaders/skin/skin.frag.glsl for their contents.
struct SkinTargets {
  FrameGraph::Handle irradiance;
  FrameGraph::Handle radiance;
  FrameGraph::Handle albedo;
  FrameGraph::Handle normal;
  FrameGraph::Handle depth;  // metres along the camera's axis
  FrameGraph::Handle z;      // the depth buffer for FullscreenPass::surface_z; no handle for
                             // multisampled targets
};

// The scene's targets before lighting. See shaders/scene/stored_facet.glsl for their contents.
struct FacetTargets {
  FrameGraph::Handle colour;
  FrameGraph::Handle normal;
  FrameGraph::Handle geometric;
  FrameGraph::Handle matter;
  FrameGraph::Handle depth;  // metres along the camera's axis
  FrameGraph::Handle z;
};

inline constexpr float kFarAway = 60000.0f;  // FAR_AWAY of the shaders: no skin

// Radiance where the skin pipeline sees no surface. Black in views of a single part of the light.
[[nodiscard]] glm::vec3 SkinBackground(const Settings& settings);

// Clears the targets and draws the scene. Requires SceneDraw::Update() once per frame.
class ScenePass {
 public:
  struct Targets {
    int width = 0;
    int height = 0;
    PixelFormat format = PixelFormat::kRgba16F;  // of the plain scene
    int samples = 4;
  };

  // Both arguments must outlive the pass.
  ScenePass(SceneDraw* scene, GlDevice* device) : scene_(scene), device_(device) {}

  // Draws the scene with lamps without shadows into one target: linear colour or data, depending on
  // the view (shaders/README.md).
  [[nodiscard]] FrameGraph::Handle AddPlain(FrameGraph* graph, const Settings& settings,
                                            const Targets& targets);
  // Draws the skin pipeline's lit scene into five targets. `shadows`: the result of ShadowPass, or
  // none.
  [[nodiscard]] SkinTargets AddSkin(FrameGraph* graph, const Settings& settings,
                                    const Targets& targets, FrameGraph::Handle shadows);
  // Draws the skin pipeline's scene without light into five targets, one sample per pixel.
  [[nodiscard]] FacetTargets AddFacets(FrameGraph* graph, const Settings& settings, int width,
                                       int height);

 private:
  // Adds a pass that brings the composed textures up to date, if necessary; at most once per graph.
  void AddComposing(FrameGraph* graph, const Settings& settings);

  SceneDraw* scene_;
  GlDevice* device_;
};

}  // namespace furrow::render

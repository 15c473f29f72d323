// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/gl/gl_device.h"
#include "render/graph/frame_graph.h"
#include "render/passes/scene_draw.h"

namespace furrow::render {

// The lit scene of the skin pipeline (shaders/skin/skin.frag.glsl). Light on skin is kept apart,
// because it scatters.
struct SkinTargets {
  FrameGraph::Handle irradiance;  // light on skin; a: metres behind the focus, kFarAway: no skin
  FrameGraph::Handle radiance;    // all other light; a: the sky's share of it
  FrameGraph::Handle albedo;      // of skin; a: the sky's share of irradiance
  FrameGraph::Handle normal;      // unit, model space; 0 without a surface
  FrameGraph::Handle depth;       // metres along the camera's axis
  FrameGraph::Handle z;  // the depth buffer, for FullscreenPass::surface_z; an empty handle if the
                         // targets have several samples per pixel
  FrameGraph::Handle motion;  // FacetTargets::motion
};

// The scene's surface properties before lighting, encoded as in shaders/scene/stored_facet.glsl.
struct FacetTargets {
  FrameGraph::Handle colour;
  FrameGraph::Handle normal;
  FrameGraph::Handle geometric;
  FrameGraph::Handle matter;
  FrameGraph::Handle depth;  // metres along the camera's axis
  FrameGraph::Handle z;
  FrameGraph::Handle emission;  // an empty handle if no material sends out light
  // Where the former picture showed the same point (motionOf() of shaders/scene/motion.glsl); an
  // empty handle if SceneDraw has no motion.
  FrameGraph::Handle motion;
};

// Depth behind the focus, in metres, that means "no skin". FAR_AWAY of the shaders. A half float
// can hold it.
inline constexpr float kFarAway = 60000.0f;

// The linear radiance of pixels without a surface: the background, or black in views that show only
// a part of the light.
[[nodiscard]] glm::vec3 SkinBackground(const Settings& settings);

// Clears the targets and draws the scene. Requires SceneDraw::Update() once per frame.
class ScenePass {
 public:
  struct Targets {
    int width = 0;
    int height = 0;
    PixelFormat format = PixelFormat::kRgba16F;  // AddPlain() only
    int samples = 4;                             // per pixel
  };

  // Both arguments must outlive the pass.
  ScenePass(SceneDraw* scene, GlDevice* device) : scene_(scene), device_(device) {}

  // Draws the scene, lit without shadows, into one target: linear colour or data, depending on
  // settings.view (shaders/README.md). Returns the target.
  [[nodiscard]] FrameGraph::Handle AddPlain(FrameGraph* graph, const Settings& settings,
                                            const Targets& targets);
  // Draws the skin pipeline's lit scene into five targets and returns them. `shadows`: the result
  // of ShadowPass::Add(), or an empty handle.
  [[nodiscard]] SkinTargets AddSkin(FrameGraph* graph, const Settings& settings,
                                    const Targets& targets, FrameGraph::Handle shadows);
  // Draws the skin pipeline's scene without light into five targets, one sample per pixel, and the
  // light that the surfaces send out and their motion into further ones, if there are any.
  [[nodiscard]] FacetTargets AddFacets(FrameGraph* graph, const Settings& settings, int width,
                                       int height);

 private:
  // Adds a pass that brings the composed textures up to date, if necessary; at most once per graph.
  void AddComposing(FrameGraph* graph, const Settings& settings);

  SceneDraw* scene_;
  GlDevice* device_;
};

}  // namespace furrow::render

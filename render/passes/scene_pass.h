// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/gl/gl_device.h"
#include "render/graph/frame_graph.h"
#include "render/passes/scene_draw.h"

namespace furrow::render {

// The scene's targets by stage of the skin pipeline; see shaders/skin/skin.frag.glsl for what each
// holds.
struct SkinTargets {
  FrameGraph::Handle irradiance;
  FrameGraph::Handle radiance;
  FrameGraph::Handle albedo;
  FrameGraph::Handle normal;
  FrameGraph::Handle depth;  // metres along the camera's axis
  FrameGraph::Handle z;      // the depth buffer, for FullscreenPass::surface_z; none of several
                             // samples
};

// The same before there is light; see shaders/scene/stored_facet.glsl.
struct FacetTargets {
  FrameGraph::Handle colour;
  FrameGraph::Handle normal;
  FrameGraph::Handle geometric;
  FrameGraph::Handle matter;
  FrameGraph::Handle depth;  // metres along the camera's axis
  FrameGraph::Handle z;
};

inline constexpr float kFarAway = 60000.0f;  // FAR_AWAY of the shaders: no skin

// Light where the skin pipeline sees no surface; black in views of single parts of the light.
[[nodiscard]] glm::vec3 SkinBackground(const Settings& settings);

// Clears and draws the scene. SceneDraw::Update() comes first, once a frame.
class ScenePass {
 public:
  struct Targets {
    int width = 0;
    int height = 0;
    PixelFormat format = PixelFormat::kRgba16F;  // of the plain scene
    int samples = 4;
  };

  // Both outlive the pass.
  ScenePass(SceneDraw* scene, GlDevice* device) : scene_(scene), device_(device) {}

  // Lamps without shadows, one target: linear colour, or data, by the view (shaders/README.md).
  [[nodiscard]] FrameGraph::Handle AddPlain(FrameGraph* graph, const Settings& settings,
                                            const Targets& targets);
  // The skin pipeline's scene: five targets. `shadows`: of ShadowPass; none without shadows.
  [[nodiscard]] SkinTargets AddSkin(FrameGraph* graph, const Settings& settings,
                                    const Targets& targets, FrameGraph::Handle shadows);
  // The skin pipeline's scene without light, one sample a pixel: five targets.
  [[nodiscard]] FacetTargets AddFacets(FrameGraph* graph, const Settings& settings, int width,
                                       int height);

 private:
  // Textures that the scene draws with, made when they are not yet; once a graph.
  void AddComposing(FrameGraph* graph, const Settings& settings);

  SceneDraw* scene_;
  GlDevice* device_;
};

}  // namespace furrow::render

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/mesh/joint_bounds.h"
#include "render/passes/composite_pass.h"
#include "render/passes/occlusion_pass.h"
#include "render/passes/scene_pass.h"
#include "render/passes/shadow_pass.h"
#include "render/passes/subsurface_pass.h"
#include "render/temporal/history.h"

namespace furrow::render {

// Builds the passes that turn posed subjects into a finished picture of one view.
//
//   plain:  scene -> composite
//   skin:   shadows -> scene (five targets) -> resolve -> occlusion, blur, occlude -> scatter ->
//           combine -> bloom -> composite -> fxaa
//   skin, one sample per pixel: shadows -> scene (facets) -> occlusion, blur -> light -> scatter ->
//           combine -> bloom -> composite -> fxaa
//   skin, a picture of a stream: the same with fewer pixels up to composite (the first: up to fxaa)
//           -> neighbours -> surround -> accumulate
//
// The frame graph culls the passes that a view does not need.
class Pipeline {
 public:
  // `character` is used only during construction; the other objects must outlive the pipeline.
  // `is_software`: the driver renders on the CPU; see AntiAliasingSettings.
  Pipeline(const character::Character& character, SceneDraw* scene, ShaderLibrary* shaders,
           GlDevice* device, bool is_software);

  struct Size {
    int width = 0;
    int height = 0;
  };
  // Adds the passes for one view. Requires SceneDraw::Update() with the same request. Returns an
  // 8-bit picture of `view`, `size` pixels, rows from the top. All views of one graph share the
  // shadow maps: set `*shadows` to an empty handle before the first call and pass it to every call.
  // `temporal`: how a picture of a stream is drawn, which must outlive the graph; null: it stands
  // alone.
  [[nodiscard]] FrameGraph::Handle Add(FrameGraph* graph, const FrameRequest& request, View view,
                                       const Size& size, FrameGraph::Handle* shadows,
                                       const TemporalFrame* temporal = nullptr);

 private:
  // The surfaces after lighting.
  struct Surface {
    SkinTargets lit;
    FrameGraph::Handle unoccluded;  // radiance before occlusion
    OcclusionPass::Openness open;
  };
  struct Skin {
    FrameGraph::Handle shown;
    SkinTargets lit;
    ScreenRect bounds;
  };
  [[nodiscard]] Skin AddSkin(FrameGraph* graph, const FrameRequest& request,
                             const Settings& settings, const TextureDesc& desc,
                             FrameGraph::Handle shadows, glm::vec2 jitter);
  [[nodiscard]] FrameGraph::Handle AddShownSkin(FrameGraph* graph, const Settings& settings,
                                                const TextureDesc& desc, const Surface& surface,
                                                FrameGraph::Handle scattered,
                                                const OcclusionGeometry& view);
  [[nodiscard]] Surface AddSurface(FrameGraph* graph, const Settings& settings,
                                   const TextureDesc& desc, FrameGraph::Handle shadows,
                                   const OcclusionGeometry& view);
  [[nodiscard]] FrameGraph::Handle AddShadowMaps(FrameGraph* graph, FrameGraph::Handle shadows,
                                                 const TextureDesc& desc);
  [[nodiscard]] FrameGraph::Handle AddShown(FrameGraph* graph, const Surface& surface, View view,
                                            const TextureDesc& desc);

  SceneDraw* scene_;
  bool is_software_;
  JointBounds skin_bounds_;
  JointBounds bounds_;
  Fullscreen fullscreen_;
  ShadowPass shadow_pass_;
  ScenePass scene_pass_;
  OcclusionPass occlusion_pass_;
  SubsurfacePass subsurface_pass_;
  CompositePass composite_pass_;
};

}  // namespace furrow::render

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/passes/occlusion_pass.h"

namespace furrow::render {

// Lights the stored facets (surface points) of a scene with one sample per pixel. Returns the
// targets that ScenePass::AddSkin() would. Each pixel is lit once, however small the triangles are
// and however many surfaces overlap.
//
// `shadows`: the result of ShadowPass; an empty handle: no shadows. `open`: the result of
// OcclusionPass::Add(), which reduces the sky's light; an empty handle in it: no occlusion. `scene`
// and `fullscreen` must outlive the graph.
[[nodiscard]] SkinTargets AddLightPass(FrameGraph* graph, const FacetTargets& facets,
                                       FrameGraph::Handle shadows,
                                       const OcclusionPass::Openness& open,
                                       const Settings& settings, const OcclusionGeometry& geometry,
                                       SceneDraw* scene, Fullscreen* fullscreen);

}  // namespace furrow::render

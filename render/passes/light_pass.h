// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/passes/occlusion_pass.h"

namespace furrow::render {

// Lights the facets of a scene with one sample per pixel. Each pixel is lit once, however small the
// triangles are and however many surfaces overlap. Reduces the sky's light by `open`. `shadows` and
// `open` may be empty handles. Returns the same targets as the lit scene pass.
[[nodiscard]] SkinTargets AddLightPass(FrameGraph* graph, const FacetTargets& facets,
                                       FrameGraph::Handle shadows,
                                       const OcclusionPass::Openness& open,
                                       const Settings& settings, const OcclusionGeometry& geometry,
                                       SceneDraw* scene, Fullscreen* fullscreen);

}  // namespace furrow::render

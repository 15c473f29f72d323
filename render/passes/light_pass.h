// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/passes/occlusion_pass.h"

namespace furrow::render {

// Lights the facets of a scene of one sample a pixel, each pixel once, however small its triangles
// are and however many lay under it. Takes from the light of the sky what `open` leaves none of.
// `shadows`, `open`: none where there are none. Returns what the lit scene pass draws at once.
[[nodiscard]] SkinTargets AddLightPass(FrameGraph* graph, const FacetTargets& facets,
                                       FrameGraph::Handle shadows,
                                       const OcclusionPass::Openness& open,
                                       const Settings& settings, const OcclusionGeometry& geometry,
                                       SceneDraw* scene, Fullscreen* fullscreen);

}  // namespace furrow::render

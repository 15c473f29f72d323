// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/passes/fullscreen.h"
#include "render/passes/scene_pass.h"

namespace furrow::render {

// Resolves the samples of the scene's targets to one per pixel (shaders/scene/resolve.frag.glsl)
// and returns the new targets. `desc` describes `scene`; targets of one sample are returned
// unchanged. `fullscreen` must outlive the graph.
[[nodiscard]] SkinTargets AddResolvePass(FrameGraph* graph, const SkinTargets& scene,
                                         const TextureDesc& desc, Fullscreen* fullscreen);

// Returns linear radiance: `scattered` (the result of SubsurfacePass) times albedo, plus the light
// of `scene` that did not scatter. Pixels outside `bounds` show no surface and get `background`.
[[nodiscard]] FrameGraph::Handle AddCombinePass(FrameGraph* graph, FrameGraph::Handle scattered,
                                                const SkinTargets& scene, const TextureDesc& desc,
                                                const ScreenRect& bounds,
                                                const glm::vec3& background,
                                                Fullscreen* fullscreen);

}  // namespace furrow::render

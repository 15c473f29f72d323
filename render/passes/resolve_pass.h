// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/passes/fullscreen.h"
#include "render/passes/scene_pass.h"

namespace furrow::render {

// Resolves the scene's samples to one per pixel (shaders/scene/resolve.frag.glsl). Returns
// single-sample targets unchanged.
[[nodiscard]] SkinTargets AddResolvePass(FrameGraph* graph, const SkinTargets& scene,
                                         const TextureDesc& desc, Fullscreen* fullscreen);

// Returns linear radiance: scattered light times albedo, plus the light that did not scatter.
// `bounds` contains all surfaces; outside, the result is `background`.
[[nodiscard]] FrameGraph::Handle AddCombinePass(FrameGraph* graph, FrameGraph::Handle scattered,
                                                const SkinTargets& scene, const TextureDesc& desc,
                                                const ScreenRect& bounds,
                                                const glm::vec3& background,
                                                Fullscreen* fullscreen);

}  // namespace furrow::render

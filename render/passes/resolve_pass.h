// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/passes/fullscreen.h"
#include "render/passes/scene_pass.h"

namespace furrow::render {

// The scene's samples made one a pixel (shaders/scene/resolve.frag.glsl). Of one sample: as they are.
[[nodiscard]] SkinTargets AddResolvePass(FrameGraph* graph, const SkinTargets& scene,
                                         const TextureDesc& desc, Fullscreen* fullscreen);

// Scattered light times albedo, plus what did not scatter: linear radiance. All surfaces lie within
// `bounds`; beyond is `background`.
[[nodiscard]] FrameGraph::Handle AddCombinePass(FrameGraph* graph, FrameGraph::Handle scattered,
                                                const SkinTargets& scene, const TextureDesc& desc,
                                                const ScreenRect& bounds,
                                                const glm::vec3& background,
                                                Fullscreen* fullscreen);

}  // namespace furrow::render

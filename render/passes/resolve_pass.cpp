// SPDX-License-Identifier: Apache-2.0
#include "render/passes/resolve_pass.h"

namespace furrow::render {

SkinTargets AddResolvePass(FrameGraph* graph, const SkinTargets& scene, const TextureDesc& desc,
                           Fullscreen* fullscreen) {
  if (desc.samples == 1) return scene;
  const auto target = [&](std::string_view name, PixelFormat format) {
    return FullscreenPass::Target{name, {desc.width, desc.height, format, 1}};
  };
  const std::vector<FrameGraph::Handle> out = fullscreen->AddPass(
      graph,
      {.name = "resolve",
       .fragment = "scene/resolve.frag.glsl",
       .defines = {"SAMPLES " + std::to_string(desc.samples)},
       .reads = {scene.irradiance, scene.radiance, scene.albedo, scene.normal, scene.depth},
       .writes = {target("irradiance", PixelFormat::kRgba16F),
                  target("radiance", PixelFormat::kRgba16F), target("albedo", PixelFormat::kRgba8),
                  target("normal", PixelFormat::kRgba16F), target("depth", PixelFormat::kR32F)}},
      [fullscreen] { fullscreen->Draw(); });
  // No depth buffer: a multisampled one cannot be attached beside the resolved targets.
  return {out[0], out[1], out[2], out[3], out[4], {}};
}

FrameGraph::Handle AddCombinePass(FrameGraph* graph, FrameGraph::Handle scattered,
                                  const SkinTargets& scene, const TextureDesc& desc,
                                  const ScreenRect& bounds, const glm::vec3& background,
                                  Fullscreen* fullscreen) {
  return fullscreen->AddSimplePass(
      graph,
      {.name = "combine",
       .fragment = "skin/combine.frag.glsl",
       .defines = {},
       .reads = {scattered, scene.radiance, scene.albedo},
       .writes = {{"combined", {desc.width, desc.height, PixelFormat::kRgba16F, 1}}},
       .surface_z = scene.z},
      [fullscreen, bounds, background] {
        fullscreen->Clear(0, background.r, background.g, background.b, 1.0f);
        fullscreen->Draw(bounds);
      });
}

}  // namespace furrow::render

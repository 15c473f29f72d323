// SPDX-License-Identifier: Apache-2.0
#include "render/passes/resolve_pass.h"

namespace furrow::render {

SkinTargets AddResolvePass(FrameGraph* graph, const SkinTargets& scene, const TextureDesc& desc,
                           Fullscreen* fullscreen) {
  if (desc.samples == 1) return scene;
  struct Data {
    SkinTargets in;
    SkinTargets out;
  };
  const Data data = graph->AddPass<Data>(
      "resolve",
      [&](FrameGraph::Builder& builder, Data& pass) {
        pass.in = scene;
        for (const auto handle :
             {scene.irradiance, scene.radiance, scene.albedo, scene.normal, scene.depth}) {
          builder.Read(handle);
        }
        const auto target = [&](std::string_view name, PixelFormat format) {
          return builder.Write(builder.Create(name, {desc.width, desc.height, format, 1}));
        };
        pass.out = {target("irradiance", PixelFormat::kRgba16F),
                    target("radiance", PixelFormat::kRgba16F),
                    target("albedo", PixelFormat::kRgba8), target("normal", PixelFormat::kRgb10A2),
                    target("depth", PixelFormat::kR32F)};
      },
      [fullscreen, samples = desc.samples](const FrameGraph::Resources& resources,
                                           const Data& pass) {
        const SkinTargets& in = pass.in;
        const SkinTargets& out = pass.out;
        Status status = fullscreen->Begin(
            "resolve.frag.glsl", {"SAMPLES " + std::to_string(samples)}, resources,
            {out.irradiance, out.radiance, out.albedo, out.normal, out.depth},
            {in.irradiance, in.radiance, in.albedo, in.normal, in.depth});
        if (status.ok()) fullscreen->Draw();
        return status;
      });
  return data.out;
}

FrameGraph::Handle AddCombinePass(FrameGraph* graph, FrameGraph::Handle scattered,
                                  const SkinTargets& scene, const TextureDesc& desc,
                                  Fullscreen* fullscreen) {
  struct Data {
    FrameGraph::Handle scattered;
    FrameGraph::Handle radiance;
    FrameGraph::Handle albedo;
    FrameGraph::Handle colour;
  };
  const Data data = graph->AddPass<Data>(
      "combine",
      [&](FrameGraph::Builder& builder, Data& pass) {
        pass = {scattered, scene.radiance, scene.albedo, {}};
        builder.Read(pass.scattered);
        builder.Read(pass.radiance);
        builder.Read(pass.albedo);
        pass.colour = builder.Write(
            builder.Create("combined", {desc.width, desc.height, PixelFormat::kRgba16F, 1}));
      },
      [fullscreen](const FrameGraph::Resources& resources, const Data& pass) {
        Status status = fullscreen->Begin("combine.frag.glsl", {}, resources, {pass.colour},
                                          {pass.scattered, pass.radiance, pass.albedo});
        if (status.ok()) fullscreen->Draw();
        return status;
      });
  return data.colour;
}

}  // namespace furrow::render

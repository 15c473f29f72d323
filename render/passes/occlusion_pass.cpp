// SPDX-License-Identifier: Apache-2.0
#include "render/passes/occlusion_pass.h"

namespace furrow::render {
namespace {

// Locations in common_view.glsl and common_occlusion.glsl.
enum Location : GLint { kViewRotation = 0, kLens = 3, kReach = 4 };
constexpr GLint kRange = 0;  // in occlusion_blur.frag.glsl and occlude.frag.glsl
// Of the radius: surfaces further apart in depth do not lend each other their openness.
constexpr float kRangeOfRadius = 0.5f;

int ScaleOf(const OcclusionSettings& settings) { return settings.half_resolution ? 2 : 1; }

TextureDesc TargetOf(const OcclusionSettings& settings, const OcclusionGeometry& geometry) {
  const int scale = ScaleOf(settings);
  return {(geometry.width + scale - 1) / scale, (geometry.height + scale - 1) / scale,
          PixelFormat::kR8, 1};
}

ScreenRect Scaled(const ScreenRect& rect, int scale) {
  return {rect.x0 / scale, rect.y0 / scale, (rect.x1 + scale - 1) / scale,
          (rect.y1 + scale - 1) / scale};
}

std::string Define(const char* name, int value) {
  return std::string(name) + " " + std::to_string(value);
}

float RangeOf(const OcclusionSettings& settings) {
  return 0.001f * settings.radius_mm * kRangeOfRadius;
}

}  // namespace

FrameGraph::Handle OcclusionPass::AddSearch(FrameGraph* graph, const SkinTargets& surface,
                                            const OcclusionSettings& settings,
                                            const OcclusionGeometry& geometry) {
  struct Data {
    FrameGraph::Handle depth;
    FrameGraph::Handle normal;
    FrameGraph::Handle open;
  };
  return graph
      ->AddPass<Data>(
          "occlusion",
          [&](FrameGraph::Builder& builder, Data& pass) {
            pass = {surface.depth, surface.normal, {}};
            builder.Read(pass.depth);
            builder.Read(pass.normal);
            pass.open =
                builder.Write(builder.Create("occlusion noisy", TargetOf(settings, geometry)));
          },
          [this, settings, geometry](const FrameGraph::Resources& resources, const Data& pass) {
            const bool gtao = settings.method == OcclusionMethod::kGtao;
            const int scale = ScaleOf(settings);
            Status status =
                fullscreen_->Begin(gtao ? "gtao.frag.glsl" : "ssao.frag.glsl",
                                   {Define("SCALE", scale), Define("SAMPLES", settings.samples)},
                                   resources, {pass.open}, {pass.depth, pass.normal});
            if (!status.ok()) return status;
            glUniformMatrix3fv(kViewRotation, 1, GL_FALSE, &geometry.view_rotation[0].x);
            glUniform4f(kLens, geometry.pixels_per_slope, 0.5f * static_cast<float>(geometry.width),
                        0.5f * static_cast<float>(geometry.height), 0.0f);
            glUniform2f(kReach, 0.001f * settings.radius_mm, settings.strength);
            fullscreen_->Clear(0, 1.0f, 1.0f, 1.0f, 1.0f);
            fullscreen_->Draw(Scaled(geometry.bounds, scale));
            return status;
          })
      .open;
}

FrameGraph::Handle OcclusionPass::AddBlur(FrameGraph* graph, FrameGraph::Handle open,
                                          FrameGraph::Handle depth,
                                          const OcclusionSettings& settings,
                                          const OcclusionGeometry& geometry) {
  struct Data {
    FrameGraph::Handle in;
    FrameGraph::Handle depth;
    FrameGraph::Handle out;
  };
  return graph
      ->AddPass<Data>(
          "occlusion blur",
          [&](FrameGraph::Builder& builder, Data& pass) {
            pass = {open, depth, {}};
            builder.Read(pass.in);
            builder.Read(pass.depth);
            pass.out = builder.Write(builder.Create("occlusion", TargetOf(settings, geometry)));
          },
          [this, settings, geometry](const FrameGraph::Resources& resources, const Data& pass) {
            const int scale = ScaleOf(settings);
            Status status = fullscreen_->Begin("occlusion_blur.frag.glsl", {Define("SCALE", scale)},
                                               resources, {pass.out}, {pass.in, pass.depth});
            if (!status.ok()) return status;
            glUniform1f(kRange, RangeOf(settings));
            fullscreen_->Clear(0, 1.0f, 1.0f, 1.0f, 1.0f);
            fullscreen_->Draw(Scaled(geometry.bounds, scale));
            return status;
          })
      .out;
}

OcclusionPass::Output OcclusionPass::Add(FrameGraph* graph, const SkinTargets& surface,
                                         const OcclusionSettings& settings,
                                         const OcclusionGeometry& geometry) {
  if (settings.method == OcclusionMethod::kOff || settings.strength <= 0.0f) return {surface, {}};
  const FrameGraph::Handle noisy = AddSearch(graph, surface, settings, geometry);
  const FrameGraph::Handle open = AddBlur(graph, noisy, surface.depth, settings, geometry);
  struct Data {
    SkinTargets in;
    FrameGraph::Handle open;
    FrameGraph::Handle irradiance;
    FrameGraph::Handle radiance;
  };
  const Data data = graph->AddPass<Data>(
      "occlude",
      [&](FrameGraph::Builder& builder, Data& pass) {
        pass = {surface, open, {}, {}};
        for (const auto handle :
             {surface.irradiance, surface.radiance, surface.albedo, surface.depth, open}) {
          builder.Read(handle);
        }
        const TextureDesc desc{geometry.width, geometry.height, PixelFormat::kRgba16F, 1};
        pass.irradiance = builder.Write(builder.Create("occluded irradiance", desc));
        pass.radiance = builder.Write(builder.Create("occluded radiance", desc));
      },
      [this, settings](const FrameGraph::Resources& resources, const Data& pass) {
        Status status = fullscreen_->Begin(
            "occlude.frag.glsl", {Define("SCALE", ScaleOf(settings))}, resources,
            {pass.irradiance, pass.radiance},
            {pass.in.irradiance, pass.in.radiance, pass.in.albedo, pass.open, pass.in.depth});
        if (!status.ok()) return status;
        glUniform1f(kRange, RangeOf(settings));
        fullscreen_->Draw();
        return status;
      });
  SkinTargets occluded = surface;
  occluded.irradiance = data.irradiance;
  occluded.radiance = data.radiance;
  return {occluded, open, ScaleOf(settings)};
}

}  // namespace furrow::render

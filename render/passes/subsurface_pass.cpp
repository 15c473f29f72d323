// SPDX-License-Identifier: Apache-2.0
#include "render/passes/subsurface_pass.h"

#include "render/pixel_kernel.h"

namespace furrow::render {
namespace {

constexpr float kFarAway = 60000.0f;  // FAR_AWAY of the shaders
constexpr float kNarrowest = 0.01f;   // of SubsurfaceSettings::width, that is worth a pass

// Locations in separable.frag.glsl.
enum Location : GLint { kAxis = 0, kNumTaps = 1, kGeometry = 2, kStrength = 3, kKernel = 4 };

}  // namespace

FrameGraph::Handle SubsurfacePass::Add(FrameGraph* graph, FrameGraph::Handle irradiance,
                                       const SubsurfaceSettings& settings,
                                       const SkinGeometry& geometry) {
  if (settings.strength <= 0.0f || settings.width < kNarrowest) return irradiance;
  switch (settings.method) {
    case SubsurfaceMethod::kOff:
    case SubsurfaceMethod::kPreintegrated: return irradiance;
    default: return AddSeparable(graph, irradiance, settings, geometry);
  }
}

FrameGraph::Handle SubsurfacePass::AddSeparable(FrameGraph* graph, FrameGraph::Handle irradiance,
                                                const SubsurfaceSettings& settings,
                                                const SkinGeometry& geometry) {
  struct Data {
    FrameGraph::Handle in;
    FrameGraph::Handle unscattered;
    FrameGraph::Handle out;
  };
  const std::vector<glm::vec4> kernel =
      PixelKernel(HumanSkin(), settings.taps, settings.width * geometry.pixels_per_mm);
  FrameGraph::Handle light = irradiance;
  for (int axis = 0; axis < 2; ++axis) {
    const Data data = graph->AddPass<Data>(
        axis == 0 ? "scatter x" : "scatter y",
        [&](FrameGraph::Builder& builder, Data& pass) {
          pass.in = light;
          pass.unscattered = irradiance;
          builder.Read(pass.in);
          builder.Read(pass.unscattered);
          const TextureDesc desc{geometry.width, geometry.height, PixelFormat::kRgba16F, 1};
          pass.out = builder.Write(builder.Create(axis == 0 ? "scattered x" : "scattered", desc));
        },
        [this, axis, kernel, settings, geometry](const FrameGraph::Resources& resources,
                                                 const Data& pass) {
          Status status = fullscreen_->Begin("separable.frag.glsl", {}, resources, {pass.out},
                                             {pass.in, pass.unscattered});
          if (!status.ok()) return status;
          glUniform2i(kAxis, axis == 0 ? 1 : 0, axis);
          glUniform1i(kNumTaps, static_cast<GLint>(kernel.size()) - 1);
          glUniform3f(kGeometry, geometry.focus_distance, 1000.0f / settings.depth_range_mm,
                      settings.gradient);
          glUniform1f(kStrength, axis == 0 ? 1.0f : settings.strength);
          glUniform4fv(kKernel, static_cast<GLsizei>(kernel.size()), &kernel[0].x);
          fullscreen_->Clear(0, 0.0f, 0.0f, 0.0f, kFarAway);
          fullscreen_->Draw(geometry.bounds);
          return status;
        });
    light = data.out;
  }
  return light;
}

}  // namespace furrow::render

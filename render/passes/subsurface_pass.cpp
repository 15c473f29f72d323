// SPDX-License-Identifier: Apache-2.0
#include "render/passes/subsurface_pass.h"

#include <array>

#include "render/passes/scene_pass.h"
#include "render/skin/subsurface_kernel.h"

namespace furrow::render {
namespace {

constexpr float kMinWidth = 0.01f;  // a smaller SubsurfaceSettings::width has no visible effect

// Uniform locations in skin/separable.frag.glsl.
enum SeparableUniform : GLint {
  kAxis = 0,
  kNumTaps = 1,
  kGeometry = 2,
  kStrength = 3,
  kOffset = 4,
  kWeight = 25
};
// Uniform locations in skin/burley.frag.glsl.
enum BurleyUniform : GLint {
  kBurleyNumTaps = 0,
  kBurleyGeometry = 1,
  kBurleyOffset = 2,
  kBurleyWeight = 66
};
constexpr GLint kSumStrength = 0;  // uniform location in skin/gaussian_sum.frag.glsl

// 32 bits, because software drivers round half floats towards zero, and the error would add up over
// the passes.
TextureDesc LightDesc(const SkinGeometry& geometry) {
  return {geometry.width, geometry.height, PixelFormat::kRgba32F, 1};
}

// Rotates a kernel that runs along x to run along y.
PixelTaps AlongY(PixelTaps kernel) {
  for (glm::vec2& offset : kernel.offsets) offset = glm::vec2(-offset.y, offset.x);
  return kernel;
}

}  // namespace

FrameGraph::Handle SubsurfacePass::Add(FrameGraph* graph, FrameGraph::Handle irradiance,
                                       const SubsurfaceSettings& settings,
                                       const SkinGeometry& geometry) {
  // Returning the input adds no pass. Later passes then read the unscattered light.
  const bool nothing_scatters =
      settings.strength <= 0.0f || settings.width < kMinWidth || geometry.bounds.empty();
  if (nothing_scatters) return irradiance;
  switch (settings.method) {
    case SubsurfaceMethod::kOff:
    case SubsurfaceMethod::kPreintegrated: break;
    case SubsurfaceMethod::kGaussians: return AddGaussians(graph, irradiance, settings, geometry);
    case SubsurfaceMethod::kSeparable: return AddSeparable(graph, irradiance, settings, geometry);
    case SubsurfaceMethod::kBurley: return AddBurley(graph, irradiance, settings, geometry);
  }
  return irradiance;
}

FrameGraph::Handle SubsurfacePass::AddAxis(FrameGraph* graph, const AxisPass& what,
                                           FrameGraph::Handle in, FrameGraph::Handle unscattered,
                                           const PixelTaps& taps,
                                           const SubsurfaceSettings& settings,
                                           const SkinGeometry& geometry) {
  return fullscreen_->AddSimplePass(
      graph,
      {.name = what.name,
       .fragment = "skin/separable.frag.glsl",
       .defines = {},
       .reads = {in, unscattered},
       .writes = {{what.target, LightDesc(geometry)}},
       .surface_z = geometry.surface_z},
      [this, what, kernel = what.axis == 0 ? taps : AlongY(taps), settings, geometry] {
        const auto count = static_cast<GLsizei>(kernel.offsets.size());
        glUniform2i(kAxis, what.axis == 0 ? 1 : 0, what.axis);
        glUniform1i(kNumTaps, count - 1);
        glUniform3f(kGeometry, geometry.focus_distance, 1000.0f / settings.depth_range_mm,
                    settings.gradient);
        glUniform1f(kStrength, what.strength);
        glUniform2fv(kOffset, count, &kernel.offsets[0].x);
        glUniform3fv(kWeight, count, &kernel.weights[0].x);
        DrawSkin(geometry);
      });
}

// `strength` applies once, in the second pass, which mixes the result with the unscattered light.
// Applied in both passes, it would act twice.
FrameGraph::Handle SubsurfacePass::AddSeparable(FrameGraph* graph, FrameGraph::Handle irradiance,
                                                const SubsurfaceSettings& settings,
                                                const SkinGeometry& geometry) {
  const PixelTaps kernel =
      PixelKernel(HumanSkin(), settings.taps, settings.width * geometry.pixels_per_mm);
  const FrameGraph::Handle across = AddAxis(graph, {"scatter x", "scattered x", 0}, irradiance,
                                            irradiance, kernel, settings, geometry);
  return AddAxis(graph, {"scatter y", "scattered", 1, settings.strength}, across, irradiance,
                 kernel, settings, geometry);
}

// Each blur continues from the result of the one before, and variances add. Seven taps per axis are
// therefore enough for each of them (GPU Gems 3, chapter 14). A blur below a third of a pixel has
// one tap and no pass; its result is its input.
FrameGraph::Handle SubsurfacePass::AddGaussians(FrameGraph* graph, FrameGraph::Handle irradiance,
                                                const SubsurfaceSettings& settings,
                                                const SkinGeometry& geometry) {
  static constexpr std::array<std::array<const char*, 2>, kNumSkinGaussians> kNames = {
      {{"gaussian 1 x", "gaussian 1 y"},
       {"gaussian 2 x", "gaussian 2 y"},
       {"gaussian 3 x", "gaussian 3 y"},
       {"gaussian 4 x", "gaussian 4 y"},
       {"gaussian 5 x", "gaussian 5 y"},
       {"gaussian 6 x", "gaussian 6 y"}}};
  const std::array<float, kNumSkinGaussians> sigmas = CascadedSigmas(HumanSkin());
  std::array<FrameGraph::Handle, kNumSkinGaussians> blurs;
  FrameGraph::Handle light = irradiance;
  for (std::size_t i = 0; i < blurs.size(); ++i) {
    const PixelTaps kernel = PixelGaussian(sigmas[i] * settings.width * geometry.pixels_per_mm);
    if (kernel.offsets.size() > 1) {
      const FrameGraph::Handle across =
          AddAxis(graph, {kNames[i][0], kNames[i][0], 0}, light, light, kernel, settings, geometry);
      light = AddAxis(graph, {kNames[i][1], kNames[i][1], 1}, across, across, kernel, settings,
                      geometry);
    }
    blurs[i] = light;
  }
  return fullscreen_->AddSimplePass(
      graph,
      {.name = "gaussian sum",
       .fragment = "skin/gaussian_sum.frag.glsl",
       .defines = {},
       .reads = {irradiance, blurs[0], blurs[1], blurs[2], blurs[3], blurs[4], blurs[5]},
       .writes = {{"scattered", LightDesc(geometry)}},
       .surface_z = geometry.surface_z},
      [this, settings, geometry] {
        glUniform1f(kSumStrength, settings.strength);
        DrawSkin(geometry);
      });
}

FrameGraph::Handle SubsurfacePass::AddBurley(FrameGraph* graph, FrameGraph::Handle irradiance,
                                             const SubsurfaceSettings& settings,
                                             const SkinGeometry& geometry) {
  // The fit depends on the profile only and takes many evaluations, so the process does it once.
  static const glm::vec3 distances = FitBurley(HumanSkin());
  return fullscreen_->AddSimplePass(
      graph,
      {.name = "burley",
       .fragment = "skin/burley.frag.glsl",
       .defines = {},
       .reads = {irradiance},
       .writes = {{"scattered", LightDesc(geometry)}},
       .surface_z = geometry.surface_z},
      [this, settings, geometry] {
        std::vector<glm::vec2> offsets;
        std::vector<glm::vec3> weights;
        for (const DiscTap& tap : BurleyDisc(distances, settings.samples)) {
          offsets.push_back(tap.offset);
          weights.push_back(tap.weight);
        }
        const auto count = static_cast<GLsizei>(offsets.size());
        glUniform1i(kBurleyNumTaps, count);
        glUniform4f(kBurleyGeometry, geometry.focus_distance, 1000.0f / settings.depth_range_mm,
                    settings.width * geometry.pixels_per_mm, settings.strength);
        glUniform2fv(kBurleyOffset, count, &offsets[0].x);
        glUniform3fv(kBurleyWeight, count, &weights[0].x);
        DrawSkin(geometry);
      });
}

// Outside the skin, the targets must read as "no skin", because the taps of nearby pixels reach
// there.
void SubsurfacePass::DrawSkin(const SkinGeometry& geometry) {
  fullscreen_->Clear(0, 0.0f, 0.0f, 0.0f, kFarAway);
  fullscreen_->Draw(geometry.bounds);
}

}  // namespace furrow::render

// SPDX-License-Identifier: Apache-2.0
#include "render/passes/occlusion_pass.h"

#include "render/gl/shader_program.h"

namespace furrow::render {
namespace {

// Uniform locations in common/view.glsl and occlusion/occlusion.glsl.
enum OcclusionUniform : GLint {
  kOcclusionViewRotation = 0,
  kOcclusionLens = 3,
  kOcclusionReach = 4
};
constexpr GLint kOcclusionRange = 0;  // in occlusion_blur.frag.glsl and occlude.frag.glsl
// As a share of the radius. Surfaces with a larger depth difference do not share their openness.
constexpr float kRangeOfRadius = 0.5f;

// Scene pixels per target pixel, along each axis.
int ScaleOf(const OcclusionSettings& settings) { return settings.half_resolution ? 2 : 1; }

// Rounds up, so that the last column and row of an odd size are covered.
TextureDesc TargetOf(const OcclusionSettings& settings, const OcclusionGeometry& geometry) {
  const int scale = ScaleOf(settings);
  return {(geometry.width + scale - 1) / scale, (geometry.height + scale - 1) / scale,
          PixelFormat::kR8, 1};
}

// Rounds outwards, so that the smaller rectangle covers all pixels of the larger one.
ScreenRect Scaled(const ScreenRect& rect, int scale) {
  return {rect.x0 / scale, rect.y0 / scale, (rect.x1 + scale - 1) / scale,
          (rect.y1 + scale - 1) / scale};
}

}  // namespace

FrameGraph::Handle OcclusionPass::AddSearch(FrameGraph* graph, FrameGraph::Handle depth,
                                            FrameGraph::Handle normal,
                                            const OcclusionSettings& settings,
                                            const OcclusionGeometry& geometry) {
  const bool gtao = settings.method == OcclusionMethod::kGtao;
  const int scale = ScaleOf(settings);
  return fullscreen_->AddSimplePass(
      graph,
      {.name = "occlusion",
       .fragment = gtao ? "occlusion/gtao.frag.glsl" : "occlusion/ssao.frag.glsl",
       .defines = {Define("SCALE", scale), Define("SAMPLES", settings.samples)},
       .reads = {depth, normal},
       .writes = {{"occlusion noisy", TargetOf(settings, geometry)}}},
      [this, settings, geometry] {
        glUniformMatrix3fv(kOcclusionViewRotation, 1, GL_FALSE, &geometry.view_rotation[0].x);
        glUniform4f(kOcclusionLens, geometry.pixels_per_slope, geometry.axis().x, geometry.axis().y,
                    0.0f);
        glUniform2f(kOcclusionReach, 0.001f * settings.radius_mm, settings.strength);
        DrawBounds(settings, geometry);
      });
}

FrameGraph::Handle OcclusionPass::AddBlur(FrameGraph* graph, FrameGraph::Handle open,
                                          FrameGraph::Handle depth,
                                          const OcclusionSettings& settings,
                                          const OcclusionGeometry& geometry) {
  return fullscreen_->AddSimplePass(graph,
                                    {.name = "occlusion blur",
                                     .fragment = "occlusion/occlusion_blur.frag.glsl",
                                     .defines = {Define("SCALE", ScaleOf(settings))},
                                     .reads = {open, depth},
                                     .writes = {{"occlusion", TargetOf(settings, geometry)}}},
                                    [this, settings, geometry] {
                                      glUniform1f(kOcclusionRange, BlurDepthLimit(settings));
                                      DrawBounds(settings, geometry);
                                    });
}

// Pixels outside the bounds are cleared to 1: open sky.
void OcclusionPass::DrawBounds(const OcclusionSettings& settings,
                               const OcclusionGeometry& geometry) {
  fullscreen_->Clear(0, 1.0f, 1.0f, 1.0f, 1.0f);
  fullscreen_->Draw(Scaled(geometry.bounds, ScaleOf(settings)));
}

OcclusionPass::Openness OcclusionPass::Add(FrameGraph* graph, FrameGraph::Handle depth,
                                           FrameGraph::Handle normal,
                                           const OcclusionSettings& settings,
                                           const OcclusionGeometry& geometry) {
  if (settings.method == OcclusionMethod::kOff || settings.strength <= 0.0f) return {};
  const FrameGraph::Handle noisy = AddSearch(graph, depth, normal, settings, geometry);
  return {AddBlur(graph, noisy, depth, settings, geometry), ScaleOf(settings)};
}

SkinTargets OcclusionPass::AddOcclude(FrameGraph* graph, const SkinTargets& lit,
                                      const Openness& open, const OcclusionSettings& settings,
                                      const OcclusionGeometry& geometry) {
  if (open.target.version < 0) return lit;
  const TextureDesc desc{geometry.width, geometry.height, PixelFormat::kRgba16F, 1};
  const std::vector<FrameGraph::Handle> left = fullscreen_->AddPass(
      graph,
      {.name = "occlude",
       .fragment = "occlusion/occlude.frag.glsl",
       .defines = {Define("SCALE", open.scale)},
       .reads = {lit.irradiance, lit.radiance, lit.albedo, open.target, lit.depth},
       .writes = {{"occluded irradiance", desc}, {"occluded radiance", desc}}},
      [this, settings, geometry] {
        glUniform1f(kOcclusionRange, BlurDepthLimit(settings));
        const glm::vec3& back = geometry.background;
        // The same values as in the scene pass: no skin in the first target, the background in the
        // second.
        fullscreen_->Clear(0, 0.0f, 0.0f, 0.0f, kFarAway);
        fullscreen_->Clear(1, back.r, back.g, back.b, 0.0f);
        fullscreen_->Draw(geometry.bounds);
      });
  SkinTargets occluded = lit;
  occluded.irradiance = left[0];
  occluded.radiance = left[1];
  return occluded;
}

float OcclusionPass::BlurDepthLimit(const OcclusionSettings& settings) {
  return 0.001f * settings.radius_mm * kRangeOfRadius;
}

}  // namespace furrow::render

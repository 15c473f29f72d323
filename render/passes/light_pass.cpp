// SPDX-License-Identifier: Apache-2.0
#include "render/passes/light_pass.h"

#include "render/gl/shader_program.h"

namespace furrow::render {
namespace {

// Uniform locations in common/view.glsl and skin/light.frag.glsl.
enum LightUniform : GLint {
  kLightViewRotation = 0,
  kLightLens = 3,
  kLightRange = 4,
  kBeforeRotation = 5,
  kBeforePosition = 8,
  kBeforeLens = 9
};
constexpr std::size_t kOpenUnit = 10;
constexpr std::size_t kStoredEmissionUnit = 11;
constexpr std::size_t kMotionUnit = 12;

// `camera`: of the former picture. `aspect`: width / height.
void SetFormerView(const CameraFrame& camera, float aspect) {
  const glm::mat3 rotation(camera.view);
  const float slope = 1.0f / camera.cot_half_fov;
  glUniformMatrix3fv(kBeforeRotation, 1, GL_FALSE, &rotation[0].x);
  glUniform4f(kBeforePosition, camera.position.x, camera.position.y, camera.position.z,
              camera.focus_distance());
  glUniform2f(kBeforeLens, aspect * slope, slope);
}

}  // namespace

SkinTargets AddLightPass(FrameGraph* graph, const FacetTargets& facets, FrameGraph::Handle shadows,
                         const OcclusionPass::Openness& open, const Settings& settings,
                         const OcclusionGeometry& geometry, SceneDraw* scene,
                         Fullscreen* fullscreen) {
  std::vector<std::string> defines = Defines(SceneDraw::LightShader(settings));
  defines.push_back(Define("OCCLUSION", open.target.version >= 0));
  defines.push_back(Define("SCALE", open.scale));
  defines.push_back(Define("EMISSION", facets.emission.version >= 0));
  const CameraFrame* before = scene->shadow_camera();
  defines.push_back(Define("SHADOWS_BEFORE", before != nullptr));
  std::vector<FrameGraph::Handle> reads = {facets.colour, facets.normal, facets.geometric,
                                           facets.matter, facets.depth};
  // The index is the texture unit. Units without a handle stay free for the look-up tables of
  // SceneDraw.
  reads.resize(kMotionUnit + 1);
  for (const GLuint unit : SceneDraw::kShadowUnits) reads[unit] = shadows;
  reads[kOpenUnit] = open.target;
  reads[kStoredEmissionUnit] = facets.emission;
  if (before != nullptr) reads[kMotionUnit] = facets.motion;
  const auto target = [&](std::string_view name, PixelFormat format) {
    return FullscreenPass::Target{name, {geometry.width, geometry.height, format, 1}};
  };
  const std::vector<FrameGraph::Handle> lit = fullscreen->AddPass(
      graph,
      {.name = "light",
       .fragment = "skin/light.frag.glsl",
       .defines = defines,
       .reads = reads,
       .writes = {target("scene irradiance", PixelFormat::kRgba16F),
                  target("scene radiance", PixelFormat::kRgba16F),
                  target("scene albedo", PixelFormat::kRgba8)},
       .surface_z = facets.z},
      [settings, geometry, scene, fullscreen] {
        const glm::vec3& back = geometry.background;
        // After the pass has bound its textures, which unbinds all units without a handle.
        scene->BindLights(settings);
        glUniformMatrix3fv(kLightViewRotation, 1, GL_FALSE, &geometry.view_rotation[0].x);
        glUniform4f(kLightLens, geometry.pixels_per_slope, geometry.axis().x, geometry.axis().y,
                    0.0f);
        glUniform1f(kLightRange, OcclusionPass::BlurDepthLimit(settings.occlusion));
        if (const CameraFrame* former = scene->shadow_camera()) {
          SetFormerView(*former,
                        static_cast<float>(geometry.width) / static_cast<float>(geometry.height));
        }
        fullscreen->Clear(0, 0.0f, 0.0f, 0.0f, kFarAway);
        fullscreen->Clear(1, back.r, back.g, back.b, 0.0f);
        fullscreen->Draw(geometry.bounds);
      });
  return {lit[0], lit[1], lit[2], facets.normal, facets.depth, facets.z, facets.motion};
}

}  // namespace furrow::render

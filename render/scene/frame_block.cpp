// SPDX-License-Identifier: Apache-2.0
#include "render/scene/frame_block.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace furrow::render {
namespace {

constexpr float kMetresPerMm = 0.001f;

// The shader receives the reciprocal of the range and the squared reach, because it needs only
// these, per pixel.
LightBlock MakeLightBlock(const LightSource& light, const ShadowView& shadow) {
  const bool placed = light.kind != LightKind::kDirectional;
  const bool spot = light.kind == LightKind::kSpot;
  return {.position = glm::vec4(light.position, placed ? 1.0f : 0.0f),
          .direction =
              glm::vec4(light.direction, spot ? std::cos(glm::radians(light.cone_degrees)) : -1.0f),
          .radiance = glm::vec4(light.radiance, light.reach * light.reach),
          .shadow_view = shadow.view,
          .shadow = {shadow.scale, shadow.near_plane, 1.0f / shadow.range,
                     shadow.perspective ? 1.0f : 0.0f}};
}

// Allowed error of hair in shadow maps, metres. 0 if no view has shadows.
float HairShadowError(const Settings& settings, std::span<const ShadowView> shadows) {
  const auto casts = [&](View view) { return NeedsSkinPipeline(view, settings); };
  if (settings.shadow.filter == ShadowFilter::kOff) return 0.0f;
  if (!AnyView(settings, casts)) return 0.0f;
  const float texel = std::ranges::min_element(shadows, {}, &ShadowView::texel)->texel;
  return std::min(settings.detail.hair_shadow_texels * texel,
                  settings.shadow.normal_offset_mm * kMetresPerMm);
}

// Radius in metres around the focus that the shadow maps cover. A picture of `radius` metres at the
// focus widens behind it, and shows surfaces up to the depth of a head or a torso.
float ShadedRadius(float radius, float distance) {
  constexpr float kDepth = 0.15f;
  return std::hypot(radius * (1.0f + kDepth / std::max(distance, kDepth)), kDepth);
}

}  // namespace

const SphericalHarmonics& AmbientCache::Get(const GradientSky& sky) {
  if (sky.zenith != sky_.zenith || sky.horizon != sky_.horizon || sky.ground != sky_.ground) {
    sky_ = sky;
    polynomial_ = AmbientPolynomial(
        ProjectRadiance([&](const glm::vec3& direction) { return SkyRadiance(sky, direction); }));
  }
  return polynomial_;
}

FrameSetup SetUpFrame(const FrameRequest& request, const wrinkle::Skeleton& skeleton,
                      AmbientCache* cache) {
  const float aspect = static_cast<float>(request.width) / static_cast<float>(request.height);
  FrameSetup setup;
  setup.camera = ComputeCamera(request.camera, skeleton, request.model, aspect, request.placement);
  setup.pixels_per_slope = setup.camera.PixelsPerSlope(request.height);
  const float radius = setup.camera.StageRadius(aspect);
  setup.lighting =
      MakeLighting(request.settings.lights, {setup.camera.heading, setup.camera.target, radius});
  setup.ambient = cache->Get(setup.lighting.sky);
  const float distance = setup.camera.focus_distance();
  const float shaded = ShadedRadius(radius, distance);
  setup.shadow_resolution =
      ShadowResolution(request.settings.shadow, shaded, distance / setup.pixels_per_slope);
  if (request.is_moving && request.settings.shadow.fit) {
    setup.shadow_resolution -= setup.shadow_resolution / 4;
  }
  for (int i = 0; i < kNumLights; ++i) {
    setup.shadows[i] =
        FitShadow(setup.lighting.lights[i], setup.camera.target, shaded, setup.shadow_resolution);
  }
  setup.hair_shadow_error = HairShadowError(request.settings, setup.shadows);
  return setup;
}

FrameBlock MakeFrameBlock(const FrameSetup& setup, const Settings& settings) {
  const CameraFrame& camera = setup.camera;
  FrameBlock block{};
  block.view_projection = camera.view_projection;
  block.camera_position = glm::vec4(camera.position, 1.0f);
  block.camera_forward =
      glm::vec4(glm::normalize(camera.target - camera.position), camera.focus_distance());
  for (int i = 0; i < kNumLights; ++i) {
    block.lights[i] = MakeLightBlock(setup.lighting.lights[i], setup.shadows[i]);
  }
  for (std::size_t i = 0; i < block.ambient.size(); ++i) {
    block.ambient[i] = glm::vec4(setup.ambient[i], 0.0f);
  }
  block.sky_zenith = glm::vec4(setup.lighting.sky.zenith, 0.0f);
  block.sky_horizon = glm::vec4(setup.lighting.sky.horizon, 0.0f);
  block.sky_ground = glm::vec4(setup.lighting.sky.ground, 0.0f);
  block.shadow_filter = {
      settings.shadow.softness_mm * kMetresPerMm, settings.shadow.lamp_mm * kMetresPerMm,
      settings.shadow.normal_offset_mm * kMetresPerMm, static_cast<float>(setup.shadow_resolution)};
  block.specular = {settings.specular.strength, settings.specular.roughness,
                    settings.specular.second_lobe, settings.subsurface.mix};
  block.translucency = {settings.translucency.enabled ? settings.translucency.strength : 0.0f,
                        settings.translucency.scale, settings.translucency.shrink_mm * kMetresPerMm,
                        settings.subsurface.strength};
  block.wrinkle_maps = {settings.wrinkle_maps.blood_flow, settings.wrinkle_maps.cavity, 0.0f, 0.0f};
  block.displacement = {settings.displacement.strength * kMetresPerMm, setup.pixels_per_slope,
                        settings.displacement.edge_pixels,
                        static_cast<float>(settings.displacement.max_level)};
  return block;
}

}  // namespace furrow::render

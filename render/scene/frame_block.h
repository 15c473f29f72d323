// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include "render/request/frame_request.h"
#include "render/scene/camera_frame.h"
#include "render/scene/lighting.h"
#include "render/scene/shadow_view.h"

namespace furrow::render {

// Mirrors Light of shaders/common/frame.glsl (std140).
struct LightBlock {
  glm::vec4 position;   // xyz; w: 1, or 0 for a light that has a direction alone
  glm::vec4 direction;  // xyz: unit, towards the light; w: cosine at a spot's edge, -1: no spot
  glm::vec4 radiance;   // rgb; w: squared distance at which it holds
  glm::mat4 shadow_view;
  glm::vec4 shadow;  // scale, near plane, 1 / range, 1 for a perspective
};

// Mirrors Frame of shaders/common/frame.glsl (std140): what is the same for all of a frame.
struct FrameBlock {
  glm::mat4 view_projection;
  glm::vec4 camera_position;  // xyz
  glm::vec4 camera_forward;   // xyz: unit; w: distance of the focus, metres
  std::array<LightBlock, kNumLights> lights;
  std::array<glm::vec4, 9> ambient;  // AmbientPolynomial() of the sky
  glm::vec4 sky_zenith;              // rgb: of GradientSky
  glm::vec4 sky_horizon;
  glm::vec4 sky_ground;
  glm::vec4 shadow_filter;  // metres: softness, lamp's radius, normal offset; w: resolution
  glm::vec4 specular;       // rho_s, scale of m, second lobe's share; w: albedo mix
  glm::vec4 translucency;   // strength, scale, shrink (metres); w: subsurface strength
  glm::vec4 wrinkle_maps;   // blood flow, cavity
  glm::vec4 displacement;  // metres a millimetre of height, FrameSetup::pixels_per_slope, pixels of
                           // an edge, most levels
};

// What a request's camera and settings make of the scene.
struct FrameSetup {
  CameraFrame camera;
  Lighting lighting;
  SphericalHarmonics ambient;  // AmbientPolynomial() of the sky
  std::array<ShadowView, kNumLights> shadows;
  int shadow_resolution = 0;       // texels a side of each map
  float hair_shadow_error = 0.0f;  // metres that hair may be off as a lamp sees it
  float pixels_per_slope = 1.0f;   // height in the picture of what is as tall as it is far away
};

// The sky's polynomial, worked out when the sky changes.
class AmbientCache {
 public:
  [[nodiscard]] const SphericalHarmonics& Get(const GradientSky& sky);

 private:
  GradientSky sky_;
  SphericalHarmonics polynomial_{};
};
[[nodiscard]] FrameSetup SetUpFrame(const FrameRequest& request, const wrinkle::Skeleton& skeleton,
                                    AmbientCache* cache);
[[nodiscard]] FrameBlock MakeFrameBlock(const FrameSetup& setup, const Settings& settings);

}  // namespace furrow::render

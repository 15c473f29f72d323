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
  glm::vec4 position;     // xyz; w: 1, or 0 for a directional light
  glm::vec4 direction;    // xyz: unit, towards the light; w: cosine at a spot's edge, -1: no spot
  glm::vec4 radiance;     // rgb: linear; w: squared distance in metres at which rgb applies
  glm::mat4 shadow_view;  // model space to the lamp's view space
  glm::vec4 shadow;       // ShadowView's scale, near plane, 1 / range; w: 1 if it is perspective
};

// Mirrors Frame of shaders/common/frame.glsl (std140): the values that are constant within a frame.
struct FrameBlock {
  glm::mat4 view_projection;  // model space to clip space
  glm::vec4 camera_position;  // xyz, model space
  glm::vec4 camera_forward;   // xyz: unit; w: focus distance, metres
  std::array<LightBlock, kNumLights> lights;
  std::array<glm::vec4, 9> ambient;  // AmbientPolynomial() of the sky
  glm::vec4 sky_zenith;              // rgb; see GradientSky
  glm::vec4 sky_horizon;
  glm::vec4 sky_ground;
  glm::vec4 shadow_filter;  // metres: softness, lamp radius, normal offset; w: resolution
  glm::vec4 specular;       // SpecularSettings: strength, roughness, second_lobe; w: albedo mix
  glm::vec4 translucency;   // strength, scale, shrink (metres); w: subsurface strength
  glm::vec4 wrinkle_maps;   // x: blood flow, y: cavity
  glm::vec4 displacement;   // metres per millimetre of height, FrameSetup::pixels_per_slope, edge
                            // length (pixels), largest level
};

// Camera, lights and shadow views of one frame, computed from a request.
struct FrameSetup {
  CameraFrame camera;
  Lighting lighting;
  SphericalHarmonics ambient;  // AmbientPolynomial() of the sky
  std::array<ShadowView, kNumLights> shadows;
  int shadow_resolution = 0;       // texels per side of each map
  float hair_shadow_error = 0.0f;  // metres; allowed error of hair in shadow maps
  float pixels_per_slope = 1.0f;   // CameraFrame::PixelsPerSlope()
};

// Caches the sky's polynomial until the sky changes.
class AmbientCache {
 public:
  [[nodiscard]] const SphericalHarmonics& Get(const GradientSky& sky);

 private:
  GradientSky sky_;
  SphericalHarmonics polynomial_{};
};
// Computes the setup of a valid request (CheckRequest()). `skeleton`: the character's. `cache`:
// kept by the caller from frame to frame.
[[nodiscard]] FrameSetup SetUpFrame(const FrameRequest& request, const wrinkle::Skeleton& skeleton,
                                    AmbientCache* cache);
// Converts setup and settings to the block that the shaders read.
[[nodiscard]] FrameBlock MakeFrameBlock(const FrameSetup& setup, const Settings& settings);

}  // namespace furrow::render

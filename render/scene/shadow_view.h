// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "render/scene/lighting.h"

namespace furrow::render {

// A lamp's view of the stage: a square picture with linear depth in metres, for all kinds of lamps.
struct ShadowView {
  glm::mat4 view{1.0f};     // model space to the lamp's, which looks along its -z
  float scale = 1.0f;       // scales xy (perspective: xy / distance) to [-1, 1]
  float near_plane = 0.0f;  // metres along -z that become depth 0
  float range = 1.0f;       // metres from depth 0 to depth 1
  bool perspective = false;
  float texel = 0.0f;  // size of a texel in metres, at the centre of the stage
};

// The view as one matrix from model space to clip space, for tests of visibility. Clip-space depth
// is always 0.
[[nodiscard]] glm::mat4 FlatProjection(const ShadowView& view);

// Returns the number of texels per side of the shadow maps for a stage of `radius` metres.
// `pixel_metres`: width of a picture pixel at the focus, metres. The result is settings.resolution,
// or less with settings.fit: a texel may be as large as a pixel, or as half the radius of the
// fixed-width filter (pcf), which blurs it anyway. It is a multiple of 128, so that it rarely
// changes while the camera moves.
[[nodiscard]] int ShadowResolution(const ShadowSettings& settings, float radius,
                                   float pixel_metres);

// Fits a lamp's shadow map of `resolution` texels per side to the stage: the sphere of `radius`
// metres around `centre` (model space).
//
// - Directional lights: an orthographic view that moves by whole texels, so that shadow edges do
//   not crawl. `radius` should stay constant from frame to frame.
// - Spots and points: one perspective view from the lamp towards the stage. Lights around a stage
//   do not need a cube map. A lamp inside the stage sees 45 degrees to each side.
// - Objects between lamp and stage also cast shadows: draw with depth clamping.
[[nodiscard]] ShadowView FitShadow(const LightSource& light, const glm::vec3& centre, float radius,
                                   int resolution);

}  // namespace furrow::render

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "render/scene/lighting.h"

namespace furrow::render {

// How a lamp sees the stage: a square picture whose depth is linear in metres, for every kind of
// lamp.
struct ShadowView {
  glm::mat4 view{1.0f};     // model space to the lamp's, which looks down its -z
  float scale = 1.0f;       // xy (perspective: over the distance) to [-1, 1] of the picture
  float near_plane = 0.0f;  // metres along -z: depth 0
  float range = 1.0f;       // metres from depth 0 to depth 1
  bool perspective = false;
  float texel = 0.0f;  // metres, at the centre of the stage
};

// The same as one matrix to clip space, but for depth, which it leaves at 0.
[[nodiscard]] glm::mat4 FlatProjection(const ShadowView& view);

// Texels a side of the maps of a stage of `radius` metres, in a picture whose pixels are
// `pixel_metres` wide at the focus: settings.resolution, or with settings.fit fewer, where a texel
// can be as large as a pixel, or as half the radius of the fixed filter that blurs it anyway. In
// steps of 128, so that a camera that moves seldom changes it.
[[nodiscard]] int ShadowResolution(const ShadowSettings& settings, float radius,
                                   float pixel_metres);

// Fits a lamp's picture of `resolution` texels a side to the sphere of the stage.
//
// - Directional: orthographic, moved in whole texels as the stage moves, so that edges of shadows
//   do not crawl (`radius` is to stay the same from frame to frame).
// - Spot and point: one perspective picture from the lamp towards the stage, which lights around a
//   stage need no cube for. A lamp inside the stage sees half a right angle to every side.
// - What stands between lamp and stage still casts: draw with depth clamping.
[[nodiscard]] ShadowView FitShadow(const LightSource& light, const glm::vec3& centre, float radius,
                                   int resolution);

}  // namespace furrow::render

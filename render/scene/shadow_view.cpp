// SPDX-License-Identifier: Apache-2.0
#include "render/scene/shadow_view.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

namespace furrow::render {
namespace {

// Texels. See ShadowResolution().
constexpr int kResolutionStep = 128;
constexpr float kMaxTangent = 1.0f;  // largest tangent of half the angle of a perspective view

// lookAt() needs an up direction that is not parallel to the view.
glm::vec3 UpFor(const glm::vec3& direction) {
  return std::abs(direction.y) > 0.99f ? glm::vec3(0.0f, 0.0f, 1.0f) : glm::vec3(0.0f, 1.0f, 0.0f);
}

ShadowView FitOrthographic(const glm::vec3& direction, const glm::vec3& centre, float radius,
                           int resolution) {
  ShadowView fitted;
  fitted.scale = 1.0f / radius;
  fitted.texel = 2.0f * radius / static_cast<float>(resolution);
  fitted.range = 2.0f * radius;
  // The lamp's axes at the model's origin. The stage's centre, snapped to whole texels along these
  // axes, shifts them.
  const glm::mat4 turn = glm::lookAt(glm::vec3(0.0f), -direction, UpFor(direction));
  const glm::vec3 there(turn * glm::vec4(centre, 1.0f));
  const glm::vec3 snapped(std::floor(there.x / fitted.texel) * fitted.texel,
                          std::floor(there.y / fitted.texel) * fitted.texel, there.z + radius);
  fitted.view = glm::translate(glm::mat4(1.0f), -snapped) * turn;
  return fitted;
}

}  // namespace

glm::mat4 FlatProjection(const ShadowView& view) {
  glm::mat4 projection(0.0f);
  projection[0].x = view.scale;
  projection[1].y = view.scale;
  if (view.perspective) {
    projection[2].w = -1.0f;
  } else {
    projection[3].w = 1.0f;
  }
  return projection * view.view;
}

int ShadowResolution(const ShadowSettings& settings, float radius, float pixel_metres) {
  if (!settings.fit) return settings.resolution;
  const float filter = settings.filter == ShadowFilter::kPcf ? 0.001f * settings.softness_mm : 0.0f;
  // Metres per texel that are fine enough for the picture.
  const float texel = std::max(pixel_metres, 0.5f * filter);
  const float steps = std::ceil(2.0f * radius / (texel * kResolutionStep));
  return std::min(settings.resolution, static_cast<int>(steps) * kResolutionStep);
}

ShadowView FitShadow(const LightSource& light, const glm::vec3& centre, float radius,
                     int resolution) {
  if (light.kind == LightKind::kDirectional) {
    return FitOrthographic(light.direction, centre, radius, resolution);
  }
  ShadowView fitted;
  // A lamp at the centre has no direction; 1 mm keeps the division finite.
  const float distance = std::max(glm::distance(light.position, centre), 1e-3f);
  const glm::vec3 towards = (light.position - centre) / distance;
  fitted.view = glm::lookAt(light.position, centre, UpFor(towards));
  fitted.perspective = true;
  // Tangent of half the angle of the cone that touches the sphere.
  const float tangent = distance > 1.01f * radius
                            ? radius / std::sqrt(distance * distance - radius * radius)
                            : kMaxTangent;
  fitted.scale = 1.0f / std::min(tangent, kMaxTangent);
  // The sphere's near side. For a lamp inside or close to the sphere, a small share of the distance
  // keeps the plane in front of the lamp.
  fitted.near_plane = std::max(distance - radius, 0.01f * distance);
  fitted.range = distance + radius - fitted.near_plane;
  fitted.texel = 2.0f * distance / (fitted.scale * static_cast<float>(resolution));
  return fitted;
}

}  // namespace furrow::render

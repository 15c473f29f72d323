// SPDX-License-Identifier: Apache-2.0
#include "render/scene/lighting.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace furrow::render {
namespace {

constexpr float kLampDistance = 7.0f;  // distance of spots and points from the focus, in radii of
                                       // the stage

// Places lamps in the camera's frame: x to the right, y up, z towards the camera.
class Placer {
 public:
  Placer(const LightSettings& settings, const Stage& stage)
      : stage_(stage), intensity_(settings.intensity) {
    const glm::mat4 turn = glm::rotate(glm::mat4(1.0f), glm::radians(settings.turn_degrees),
                                       glm::vec3(0.0f, 1.0f, 0.0f));
    const glm::mat4 tilt =
        glm::rotate(turn, -glm::radians(settings.tilt_degrees), glm::vec3(1.0f, 0.0f, 0.0f));
    frame_ = stage.heading * glm::mat3(tilt);
  }

  [[nodiscard]] glm::vec3 Direction(const glm::vec3& towards) const {
    return frame_ * glm::normalize(towards);
  }
  [[nodiscard]] LightSource Directional(const glm::vec3& towards, const glm::vec3& radiance) const {
    LightSource light;
    light.direction = Direction(towards);
    light.radiance = intensity_ * radiance;
    return light;
  }
  [[nodiscard]] LightSource Point(const glm::vec3& towards, const glm::vec3& radiance) const {
    LightSource light = Directional(towards, radiance);
    light.kind = LightKind::kPoint;
    light.reach = kLampDistance * stage_.radius;
    light.position = stage_.focus + light.reach * light.direction;
    return light;
  }
  [[nodiscard]] LightSource Spot(const glm::vec3& towards, const glm::vec3& radiance,
                                 float cone_degrees) const {
    LightSource light = Point(towards, radiance);
    light.kind = LightKind::kSpot;
    light.cone_degrees = cone_degrees;
    return light;
  }

 private:
  const Stage& stage_;
  float intensity_;
  glm::mat3 frame_;
};

}  // namespace

Lighting MakeLighting(const LightSettings& settings, const Stage& stage) {
  const Placer place(settings, stage);
  Lighting lighting;
  switch (settings.preset) {
    case LightPreset::kStudio:
      // A portrait: a warm key from the left, a cool fill from the right, a third as bright with
      // the sky, and a rim from behind. Key and fill come from the sides, where both show folds.
      // The rim is so far behind that it grazes the outline only. Radiance is linear.
      lighting.lights = {place.Spot({-0.78f, 0.72f, 0.76f}, {1.12f, 0.98f, 0.84f}, 24.0f),
                         place.Point({0.84f, 0.46f, 0.52f}, {0.22f, 0.225f, 0.25f}),
                         place.Directional({0.58f, 0.25f, -1.05f}, {0.28f, 0.31f, 0.36f})};
      lighting.sky = {{0.150f, 0.155f, 0.165f}, {0.080f, 0.078f, 0.078f}, {0.045f, 0.038f, 0.034f}};
      break;
    case LightPreset::kHard:
      lighting.lights = {place.Spot({-0.75f, 0.95f, 0.45f}, {2.10f, 1.95f, 1.78f}, 24.0f),
                         place.Point({0.9f, 0.0f, 0.6f}, {0.0f, 0.0f, 0.0f}),
                         place.Directional({0.72f, 0.42f, -0.75f}, {0.0f, 0.0f, 0.0f})};
      lighting.sky = {glm::vec3(0.045f), glm::vec3(0.028f), glm::vec3(0.016f)};
      break;
    case LightPreset::kThesis:
      lighting.lights = {place.Directional({-0.75f, 0.45f, 0.65f}, glm::vec3(0.75f)),
                         place.Directional({0.80f, 0.35f, 0.60f}, glm::vec3(0.45f)),
                         place.Directional({0.10f, 0.60f, -0.80f}, glm::vec3(0.45f))};
      lighting.sky = {glm::vec3(0.06f), glm::vec3(0.05f), glm::vec3(0.04f)};
      break;
  }
  for (glm::vec3* colour : {&lighting.sky.zenith, &lighting.sky.horizon, &lighting.sky.ground}) {
    *colour *= settings.ambient * settings.sky;
  }
  // A filter of 0 turns a lamp off; dark lamps get no shadow map.
  const glm::vec3 filters[] = {settings.key, settings.fill, settings.rim};
  for (std::size_t i = 0; i < lighting.lights.size(); ++i)
    lighting.lights[i].radiance *= filters[i];
  return lighting;
}

}  // namespace furrow::render

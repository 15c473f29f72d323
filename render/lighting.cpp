// SPDX-License-Identifier: Apache-2.0
#include "render/lighting.h"

#include <glm/geometric.hpp>

namespace furrow::render {

Lighting StudioLighting(const glm::mat3& heading) {
  const auto light = [&](const glm::vec3& towards, const glm::vec3& radiance) {
    return Light{glm::vec4(heading * glm::normalize(towards), 0.0f), glm::vec4(radiance, 0.0f)};
  };
  // Directions in the camera's frame: x to its right, y up, z back towards it.
  return {.lights = {light({-0.75f, 0.75f, 0.55f}, {1.12f, 0.98f, 0.83f}),
                     light({0.85f, 0.10f, 0.55f}, {0.10f, 0.14f, 0.20f}),
                     light({0.70f, 0.45f, -0.75f}, {0.42f, 0.50f, 0.62f})},
          .ambient_sky = {0.060f, 0.070f, 0.086f, 0.0f},
          .ambient_ground = {0.030f, 0.025f, 0.022f, 0.0f}};
}

}  // namespace furrow::render

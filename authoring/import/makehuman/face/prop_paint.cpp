// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/face/prop_paint.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "authoring/paint/canvas.h"
#include "authoring/paint/noise.h"

namespace furrow::authoring {
namespace {

character::Picture Filled(const char* name, int size, const glm::vec3& fill) {
  character::Picture picture = BlankPicture(name, size, size, 3);
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) SetTexel(&picture, x, y, glm::vec4(fill, 1.0f));
  }
  return picture;
}

// Angles of an adult eye with a radius of 12 mm and an iris 11.7 mm wide.
constexpr float kIris = 0.509f;
constexpr float kPupil = 0.17f;

glm::vec3 EyeColour(float angle, float around) {
  constexpr glm::vec3 kWhite{0.86f, 0.84f, 0.81f};
  constexpr glm::vec3 kVeins{0.80f, 0.62f, 0.58f};
  constexpr glm::vec3 kRim{0.10f, 0.10f, 0.12f};
  constexpr glm::vec3 kOuter{0.22f, 0.30f, 0.34f};
  constexpr glm::vec3 kInner{0.42f, 0.40f, 0.28f};
  const glm::vec3 ring(std::cos(around), std::sin(around), 0.0f);
  const float veins = ValueNoise(glm::vec3(ring * 9.0f) + glm::vec3(0.0f, 0.0f, angle * 6.0f));
  const float redness = glm::smoothstep(0.6f, 1.3f, angle) * (0.35f + 0.4f * veins);
  const glm::vec3 white = glm::mix(kWhite, kVeins, redness);
  const float fibres = ValueNoise(ring * 24.0f + glm::vec3(0.0f, 0.0f, angle * 5.0f));
  const float out = std::clamp((angle - kPupil) / (kIris - kPupil), 0.0f, 1.0f);
  glm::vec3 iris = glm::mix(kInner, kOuter, glm::smoothstep(0.1f, 0.6f, out));
  iris *= 0.75f + 0.5f * fibres;
  iris = glm::mix(iris, kRim, glm::smoothstep(0.72f, 1.0f, out));
  glm::vec3 colour = glm::mix(iris, white, glm::smoothstep(kIris - 0.03f, kIris + 0.03f, angle));
  return glm::mix(glm::vec3(0.015f), colour,
                  glm::smoothstep(kPupil - 0.015f, kPupil + 0.015f, angle));
}

// Real threads, 1.4 mm apart, would alias in the texture of a whole body. The weave is drawn at 3
// mm, which looks like coarse twill.
float Weave(const glm::vec3& p) {
  constexpr float kThread = 2.0f * std::numbers::pi_v<float> / 0.003f;
  return 0.5f + 0.25f * std::sin(kThread * (p.x + p.z + 0.5f * p.y)) +
         0.25f * std::sin(kThread * (p.x + p.z - p.y));
}

template <class Height>
glm::vec2 Slope(const SurfaceTexel& texel, float step, const Height& height) {
  const auto along = [&](const glm::vec3& axis) {
    return (height(texel.position + axis * step) - height(texel.position - axis * step)) /
           (2.0f * step);
  };
  return {-along(texel.tangent), -along(texel.bitangent)};
}

}  // namespace

character::Picture PaintEye(int size) {
  character::Picture picture = BlankPicture("eye_colour", size, size, 3);
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const glm::vec2 p = (glm::vec2(static_cast<float>(x), static_cast<float>(y)) + 0.5f) /
                              (0.5f * static_cast<float>(size)) -
                          1.0f;
      SetTexel(&picture, x, y,
               glm::vec4(EyeColour(glm::length(p) * kEyePictureAngle, std::atan2(p.y, p.x)), 1.0f));
    }
  }
  return picture;
}

character::Picture PaintCloth(const std::vector<SurfaceTexel>& texels, float waist, int size) {
  constexpr glm::vec3 kShirt{0.42f, 0.46f, 0.50f};
  constexpr glm::vec3 kTrousers{0.20f, 0.22f, 0.27f};
  character::Picture picture = Filled("cloth_colour", size, kShirt);
  for (const SurfaceTexel& texel : texels) {
    const float above = glm::smoothstep(waist - 0.004f, waist + 0.004f, texel.position.y);
    const float worn = ValueNoise(texel.position / 0.06f) - 0.5f;
    const glm::vec3 colour =
        glm::mix(kTrousers, kShirt, above) * (0.92f + 0.12f * Weave(texel.position) + 0.08f * worn);
    SetTexel(&picture, texel.x, texel.y, glm::vec4(colour, 1.0f));
  }
  Dilate(&picture, texels, kSeamTexels);
  return picture;
}

character::Picture PaintWeaveNormals(const std::vector<SurfaceTexel>& texels, int size) {
  character::Picture picture = Filled("cloth_normal", size, glm::vec3(0.5f, 0.5f, 1.0f));
  for (const SurfaceTexel& texel : texels) {
    const glm::vec2 slope =
        Slope(texel, 0.0004f, [](const glm::vec3& p) { return 0.00012f * Weave(p); });
    SetTexel(&picture, texel.x, texel.y,
             glm::vec4(glm::normalize(glm::vec3(slope, 1.0f)) * 0.5f + 0.5f, 1.0f));
  }
  Dilate(&picture, texels, kSeamTexels);
  return picture;
}

}  // namespace furrow::authoring

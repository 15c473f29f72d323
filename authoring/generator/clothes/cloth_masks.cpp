// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/clothes/cloth_masks.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include "authoring/generator/mesh/mesh_tools.h"
#include "authoring/paint/canvas.h"
#include "authoring/paint/surface_texels.h"
#include "base/scalar.h"

namespace furrow::authoring {
namespace {

using glm::vec3;
using glm::vec4;

float Side(float x, float soft) { return Smoothstep(-soft, soft, x); }

// Puts (a, b) into the first two channels on the left side and into the last two on the right.
vec4 BySide(const vec3& p, float a, float b, float soft) {
  const float left = Side(p.x, soft);
  return {a * left, b * left, a * (1.0f - left), b * (1.0f - left)};
}

// Arms lie along X at rest. They fold in front, toward the forearm.
vec4 Elbows(const vec3& p) {
  // Folds fade before the gathers of the cuff, and below the armpit.
  const float along = std::abs(p.x) - 0.455f;
  const float near =
      along > 0.0f ? Smoothstep(0.19f, 0.13f, along) : Smoothstep(-0.215f, -0.10f, along);
  const float inner = Side(p.z + 0.018f, 0.038f);
  return BySide(p, near * inner, near * (1.0f - inner), 0.01f);
}

// Knees fold behind.
vec4 Knees(const vec3& p) {
  const float near = Smoothstep(0.30f, 0.08f, std::abs(p.y - 0.495f));
  const float outer = Side(p.z - 0.002f, 0.045f);
  return BySide(p, near * (1.0f - outer), near * outer, 0.01f);
}

vec4 Hips(const vec3& p) {
  const float near = Smoothstep(0.56f, 0.72f, p.y) * Smoothstep(1.005f, 0.965f, p.y) *
                     Smoothstep(0.30f, 0.24f, std::abs(p.x));
  const float front = Side(p.z, 0.05f);
  return BySide(p, near * front, near * (1.0f - front), 0.035f);
}

vec4 Shoulders(const vec3& p) {
  const float x = std::abs(p.x);
  const float near =
      Smoothstep(0.03f, 0.11f, x) * Smoothstep(0.40f, 0.30f, x) * Smoothstep(1.08f, 1.24f, p.y);
  const float front = Side(p.z + 0.015f, 0.04f);
  return BySide(p, near * front, near * (1.0f - front), 0.01f);
}

// Front, back, left and right with the weights of a ball driver's quarters: squared cosines.
vec4 Waist(const vec3& p) {
  const float near = Smoothstep(0.965f, 1.02f, p.y) * Smoothstep(1.33f, 1.18f, p.y) *
                     Smoothstep(0.30f, 0.24f, std::abs(p.x));
  const float length = std::max(std::hypot(p.x, p.z), 1e-4f);
  const float across = p.x / length, ahead = p.z / length;
  const auto square = [](float v) { return v > 0.0f ? v * v : 0.0f; };
  return near * vec4(square(ahead), square(-ahead), square(across), square(-across));
}

// The collar, and the ends of the trousers. They stack on the shoes, most in front, and the hem
// itself is stiff.
vec4 Ends(const vec3& p) {
  const float collar = Smoothstep(1.38f, 1.44f, p.y) * Smoothstep(0.15f, 0.09f, std::abs(p.x));
  const float stack = Smoothstep(0.26f, 0.10f, p.y) * Smoothstep(0.05f, 0.07f, p.y) *
                      std::lerp(0.6f, 1.0f, Side(p.z + 0.004f, 0.05f));
  const float left = Side(p.x, 0.03f);
  return {collar * left, collar * (1.0f - left), stack * left, stack * (1.0f - left)};
}

// From the elbow to the cuff.
vec4 Forearms(const vec3& p) {
  const float x = std::abs(p.x);
  const float near = Smoothstep(0.40f, 0.48f, x) * Smoothstep(0.665f, 0.60f, x);
  const float left = Side(p.x, 0.01f);
  return {near * left, near * (1.0f - left), 0.0f, 0.0f};
}

}  // namespace

std::array<character::Picture, 7> PaintClothMasks(const Clothes& clothes, int size) {
  using Regions = vec4 (*)(const vec3&);
  constexpr Regions kRegions[] = {Elbows, Knees, Hips, Shoulders, Waist, Ends, Forearms};
  const std::vector<SurfaceTexel> texels = RasterizeSurface(clothes.mesh, size, size);
  std::array<character::Picture, 7> masks;
  for (std::size_t i = 0; i < masks.size(); ++i) {
    const auto regions = [&](const SurfaceTexel& texel) { return kRegions[i](texel.position); };
    masks[i] = FillPicture(kClothMaskNames[i], texels, size, 4, regions);
  }
  return masks;
}

}  // namespace furrow::authoring

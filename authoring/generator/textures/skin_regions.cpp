// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/textures/skin_regions.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "authoring/generator/head/head_shape.h"
#include "authoring/generator/mesh/mesh_tools.h"
#include "authoring/paint/noise.h"
#include "base/scalar.h"

namespace furrow::authoring {

using glm::vec3;

float Spot(const vec3& p, const vec3& centre, const vec3& radii) {
  const vec3 d = (p - centre) / radii;
  return std::exp(-glm::dot(d, d));
}

vec3 OnLeftSide(const vec3& p) { return {std::abs(p.x), p.y, p.z}; }

bool OnHand(const SurfaceTexel& texel) { return std::abs(texel.position.x) > 0.4f; }

float NearLids(const vec3& eye) {
  return Smoothstep(1.80f, 1.6f, std::abs(eye.x)) * Smoothstep(0.0f, 0.4f, eye.z);
}

float LipShare(const vec3& p) {
  const float x = std::abs(p.x);
  const float reach = 1.0f - std::pow(std::min(x / 2.72f, 1.0f), 2.0f);
  const float bow = 0.09f * Bump(x - 0.62f, 0.38f) - 0.07f * Bump(x, 0.22f);
  const float top = kMouthY + 0.72f * std::pow(reach, 0.85f) + bow * reach;
  const float bottom = kMouthY - 0.88f * std::pow(reach, 0.7f);
  const float ragged = 0.02f * SignedNoise(p * 9.0f);
  const float edge = 0.08f;
  return Smoothstep(top + edge, top - edge, p.y + ragged) *
         Smoothstep(bottom - edge, bottom + edge, p.y + ragged) * Smoothstep(2.8f, 2.5f, x) *
         Smoothstep(5.0f, 6.5f, p.z);
}

}  // namespace furrow::authoring

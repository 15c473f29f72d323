// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/textures/skin_relief.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "authoring/generator/head/face_parts.h"
#include "authoring/generator/head/hair_style.h"
#include "authoring/generator/mesh/mesh_tools.h"
#include "authoring/generator/textures/skin_regions.h"
#include "authoring/paint/canvas.h"
#include "authoring/paint/noise.h"
#include "authoring/paint/strokes.h"
#include "base/scalar.h"

namespace furrow::authoring {
namespace {

using glm::vec2;
using glm::vec3;

// How coarse the pores are: coarsest on nose and inner cheeks, finest on the lids.
float PoreShare(const vec3& q) {
  const float coarse = 0.45f + 0.9f * Spot(q, {0, -3.8f, 10.6f}, {1.7f, 1.4f, 2.0f}) +
                       0.8f * Spot(q, {2.7f, -3.2f, 8.6f}, {1.9f, 1.7f, 3.0f}) +
                       0.35f * Spot(q, {0, 4.0f, 9.3f}, {4.0f, 2.2f, 3.0f}) +
                       0.4f * Spot(q, {0, -10.0f, 9.2f}, {1.8f, 1.2f, 2.0f});
  return coarse * (1.0f - 0.8f * Spot(q, {3.2f, 0.0f, 8.4f}, {1.8f, 1.1f, 2.0f}));
}

// Fine lines run across the pull of the muscle below: level on the forehead, fanned around the
// eyes, down from the nose over the cheeks.
float FineLines(const vec3& q, float age) {
  const float brow = Spot(q, {0, 4.2f, 9.0f}, {6.0f, 2.0f, 5.0f});
  const float cheek = Spot(q, {4.2f, -4.0f, 7.0f}, {2.4f, 3.0f, 4.0f});
  const float eye = Spot(q, {4.6f, -0.6f, 7.6f}, {1.6f, 1.2f, 2.0f});
  const vec2 from(q.x - 2.6f, q.y);
  const float turn = std::atan2(from.y, from.x);
  const float level = SignedNoise({q.x * 1.2f, q.y * 9.0f, q.z * 1.2f});
  const float slant =
      SignedNoise({(q.x + 0.45f * q.y) * 9.0f, (q.y - 0.45f * q.x) * 1.5f, q.z * 2.0f});
  const float fan = SignedNoise({turn * 26.0f, glm::length(from) * 1.1f, 3.0f});
  return (0.5f + age) * (brow * level + 0.7f * cheek * slant + (0.6f + 1.2f * age) * eye * fan);
}

float Height(const vec3& p, const FaceParameters& face) {  // centimetres
  const vec3 q = OnLeftSide(p);
  const float grain = SignedNoise(p * 13.0f) + 0.7f * SignedNoise(p * 22.0f + 5.0f);
  const float pits = -1.6f * Smoothstep(0.45f, 0.75f, SignedNoise(p * 17.0f + 11.0f));
  const float lips = LipShare(p);
  const float creases = SignedNoise({p.x * 13.0f, p.y * 2.2f, 2.0f});
  return (1.0f - lips) *
             (0.0022f * PoreShare(q) * (grain + pits) + 0.0030f * FineLines(q, AgeShare(face))) +
         0.0028f * lips * creases;
}

// The thickness of the flesh between a point of the skin and the nearest exit behind it,
// centimetres.
float Thickness(const HeadShape& shape, const vec3& p, const vec3& normal) {
  constexpr float kLongest = 100.0f * kFullThickness;
  float t = 0.12f;
  while (t < kLongest) {
    const float inside = -shape.Distance(p - normal * t);
    if (inside < 0.02f) return t;
    t += std::max(0.6f * inside, 0.06f);
  }
  return kLongest;
}

// The tear film on the edges of the lids: 1 beside the eyeball, 0 from 1.5 mm on.
float WetLid(const vec3& p) {
  const vec3 eye = p - EyeCentre(p.x > 0.0f ? 1.0f : -1.0f);
  return Smoothstep(1.38f, 1.27f, glm::length(eye)) * NearLids(eye);
}

}  // namespace

character::Picture PaintSkinNormals(const character::Mesh& skin, const HeadShape& shape, int size) {
  const std::vector<SurfaceTexel> texels = RasterizeSurface(skin, size, size);
  std::vector<vec2> slopes;
  slopes.reserve(texels.size());
  constexpr float kStep = 0.03f;
  for (const SurfaceTexel& texel : texels) {
    const vec3 p = ModelToHead(texel.position);
    const float here = Height(p, shape.face());
    slopes.emplace_back((here - Height(p + texel.tangent * kStep, shape.face())) / kStep,
                        (here - Height(p + texel.bitangent * kStep, shape.face())) / kStep);
  }
  character::Picture picture = EncodeNormals(texels, slopes, size, size, kSkinNormalBits);
  picture.name = "skin_normal";
  return picture;
}

character::Picture PaintSkinRoughness(const character::Mesh& skin, int size) {
  return FillPicture("skin_roughness", RasterizeSurface(skin, size, size), size, 3,
                     [](const SurfaceTexel& texel) -> glm::vec4 {
                       const vec3 p = ModelToHead(texel.position);
                       const vec3 q = OnLeftSide(p);
                       float rough = 0.56f + 0.05f * FractalNoise(p * 3.0f);
                       if (!OnHand(texel)) {
                         rough -= 0.12f * Spot(q, {0, 4.5f, 9.0f}, {3.5f, 2.2f, 3.0f});
                         rough -= 0.16f * Spot(q, {0, -2.8f, 10.4f}, {1.2f, 2.2f, 2.0f});
                         rough -= 0.08f * Spot(q, {0, -10.0f, 9.2f}, {1.5f, 1.0f, 2.0f});
                         rough -= 0.10f * Spot(q, {3.3f, 0.7f, 8.5f}, {1.7f, 0.7f, 1.5f});
                         rough += 0.05f * Spot(q, {5.2f, -5.0f, 5.0f}, {1.8f, 2.5f, 3.0f});
                         rough = glm::mix(rough, 0.42f, LipShare(p));
                         rough += 0.16f * Smoothstep(7.4f, 7.9f, q.x);  // ears are dry
                         rough = glm::mix(rough, 0.2f, WetLid(p));
                         // Hair roots make the skin dull.
                         rough = glm::mix(rough, 1.0f, Smoothstep(-0.5f, 0.4f, InsideHairline(p)));
                         rough = glm::mix(rough, 0.9f, Bump(p.y - kMouthY, 0.10f) * LipShare(p));
                       }
                       return {0.0f, std::clamp(rough, 0.0f, 1.0f), 0.0f, 1.0f};
                     });
}

character::Picture PaintSkinThickness(const character::Mesh& skin, const HeadShape& shape,
                                      int size) {
  return FillPicture(
      "skin_thickness", RasterizeSurface(skin, size, size), size, 3,
      [&shape](const SurfaceTexel& texel) -> glm::vec4 {
        const vec3 p = ModelToHead(texel.position);
        float thick = 1.2f;  // fingers
        if (!OnHand(texel)) {
          // Ears are separate surfaces that stand off the head: 2 mm of cartilage, and a thicker
          // lobe.
          const float off = shape.Distance(p);
          const float ear = glm::mix(0.32f, 0.16f, Smoothstep(-4.6f, -3.2f, p.y));
          thick = off > 0.15f ? ear : Thickness(shape, p, texel.normal);
        }
        return {0.0f, std::clamp(thick / (100.0f * kFullThickness), 0.0f, 1.0f), 0.0f, 1.0f};
      });
}

}  // namespace furrow::authoring

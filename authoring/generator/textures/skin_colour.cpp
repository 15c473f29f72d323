// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/textures/skin_colour.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "authoring/generator/head/face_parts.h"
#include "authoring/generator/head/hair_style.h"
#include "authoring/generator/mesh/mesh_tools.h"
#include "authoring/generator/textures/head_brows.h"
#include "authoring/generator/textures/skin_regions.h"
#include "authoring/paint/canvas.h"
#include "authoring/paint/noise.h"
#include "base/scalar.h"

namespace furrow::authoring {
namespace {

using glm::vec3;

// How much beard grows at a point: on chin, jaw and upper lip, not in the hollow under the lower
// lip.
float BeardShare(const vec3& p) {
  const vec3 q = OnLeftSide(p);
  const float jaw = Smoothstep(-4.6f, -7.4f, q.y + 0.30f * (8.0f - q.z)) *
                    Smoothstep(-14.5f, -12.0f, q.y) * Smoothstep(-1.5f, 1.5f, q.z);
  const float lip = Spot(q, {1.2f, -5.7f, 9.6f}, {1.5f, 0.55f, 2.0f});
  const float cheek = 1.0f - Smoothstep(0.0f, 1.0f, Spot(q, {3.4f, -5.2f, 7.6f}, {1.5f, 1.6f, 2}));
  return std::max(jaw * cheek, lip);
}

// Blood near the surface: cheeks, nose, chin and ears.
float Redness(const vec3& q) {
  return 0.80f * Spot(q, {4.4f, -3.0f, 7.0f}, {1.9f, 1.5f, 3.0f}) +
         0.60f * Spot(q, {0.2f, -3.9f, 11.0f}, {1.3f, 1.1f, 1.8f}) +
         0.30f * Spot(q, {0.0f, -10.0f, 9.3f}, {1.6f, 1.1f, 2.0f}) +
         0.55f * Spot(q, {1.6f, -4.4f, 9.3f}, {0.7f, 0.8f, 1.2f}) +
         0.45f * Smoothstep(6.6f, 7.6f, q.x) * Smoothstep(3.4f, 1.4f, std::abs(q.y + 1.5f));
}

vec3 AroundEyes(vec3 colour, const vec3& q, float age) {
  const float under = Spot(q, {2.9f, -1.05f, 8.4f}, {1.3f, 0.55f, 1.5f});
  const float inner = Spot(q, {1.75f, 0.15f, 8.5f}, {0.6f, 0.9f, 1.4f});
  const float lid = Spot(q, {3.3f, 0.85f, 8.4f}, {1.6f, 0.5f, 1.2f});
  const float shade = (0.32f + 0.3f * age) * under + 0.35f * inner + 0.22f * lid;
  return glm::mix(colour, vec3(0.60f, 0.42f, 0.39f), std::clamp(shade, 0.0f, 0.6f));
}

vec3 Marks(vec3 colour, const vec3& p, const vec3& q, float age) {
  const float freckle = Smoothstep(0.50f, 0.75f, SignedNoise(p * 9.0f)) *
                        Spot(q, {2.6f, -2.2f, 8.7f}, {3.4f, 1.6f, 3.5f});
  colour = glm::mix(colour, vec3(0.58f, 0.38f, 0.28f), 0.16f * freckle);
  const float spots = Smoothstep(0.62f, 0.78f, SignedNoise(p * 2.3f + 40.0f)) *
                      Smoothstep(2.0f, 5.0f, q.x) * Smoothstep(-8.0f, 3.0f, q.y);
  colour = glm::mix(colour, vec3(0.58f, 0.42f, 0.32f), 0.45f * age * spots);
  const float mole = Smoothstep(0.11f, 0.07f, glm::distance(p, vec3(-3.75f, -4.6f, 8.0f)));
  return glm::mix(colour, vec3(0.32f, 0.20f, 0.15f), 0.8f * mole);
}

vec3 BareSkin(const vec3& p, const vec3& normal, const FaceParameters& face) {
  const vec3 q = OnLeftSide(p);
  const float age = AgeShare(face);
  vec3 colour =
      glm::mix(vec3(0.815f, 0.635f, 0.535f), vec3(0.785f, 0.595f, 0.495f), 0.5f + 0.5f * face.sex);
  colour = glm::mix(colour, vec3(0.79f, 0.65f, 0.55f), 0.6f * age);
  const float blotch = FractalNoise(p * 0.9f);
  const float fine = FractalNoise(p * 5.0f);
  const float red = Redness(q) * (0.75f + 0.35f * blotch + 0.25f * SignedNoise(p * 2.6f));
  colour = glm::mix(colour, vec3(0.78f, 0.43f, 0.36f), std::clamp(0.50f * red, 0.0f, 0.55f));
  const float yellow = Spot(q, {0, 5.0f, 8.5f}, {5.0f, 2.6f, 4.0f});
  colour = glm::mix(colour, vec3(0.83f, 0.67f, 0.54f), 0.45f * yellow);
  colour = AroundEyes(colour, q, age);
  const float beard = BeardShare(p) * std::max(face.sex, 0.0f);
  const float stubble = beard * (0.62f + 0.38f * Smoothstep(-0.2f, 0.6f, SignedNoise(p * 17.0f)));
  colour = glm::mix(colour, vec3(0.42f, 0.37f, 0.36f), (0.34f - 0.12f * age) * stubble);
  colour *= 1.0f + 0.03f * blotch + 0.035f * fine;
  colour = Marks(colour, p, q, age);
  // Nostrils are dark inside.
  const float nostril =
      Spot(q, {0.72f, -4.55f, 9.9f}, {0.36f, 0.34f, 0.6f}) * Smoothstep(0.0f, -0.6f, normal.y);
  return glm::mix(colour, vec3(0.20f, 0.08f, 0.06f), std::clamp(1.5f * nostril, 0.0f, 0.93f));
}

vec3 Lips(vec3 colour, const vec3& p, const FaceParameters& face) {
  const float lips = LipShare(p);
  const float age = AgeShare(face);
  vec3 red =
      glm::mix(vec3(0.68f, 0.34f, 0.32f), vec3(0.66f, 0.40f, 0.355f), 0.5f + 0.5f * face.sex);
  red = glm::mix(red, vec3(0.64f, 0.42f, 0.38f), 0.6f * age);
  const float lines = 0.07f * SignedNoise({p.x * 12.0f, p.y * 1.8f, 5.0f});
  const float upper = Smoothstep(-0.1f, 0.25f, p.y - kMouthY);  // thinner light, deeper red
  colour = glm::mix(colour, red * (1.0f + lines - 0.06f * upper), (0.86f - 0.1f * age) * lips);
  // Wet skin at the line where the lips meet. Shadows darken it while the mouth is closed.
  const float line = Bump(p.y - kMouthY + 0.02f * std::abs(p.x), 0.07f) *
                     Smoothstep(2.75f, 2.3f, std::abs(p.x)) * Smoothstep(5, 7, p.z);
  return glm::mix(colour, vec3(0.42f, 0.17f, 0.16f), 0.55f * line);
}

// The edges of the lids: wet and pink at the eyeball, dark where the lashes grow.
vec3 LidRims(vec3 colour, const vec3& p) {
  const vec3 q = OnLeftSide(p);
  const vec3 eye = p - EyeCentre(p.x > 0.0f ? 1.0f : -1.0f);
  const float ball = glm::length(eye);
  const float near = NearLids(eye);
  const float wet = Smoothstep(1.36f, 1.27f, ball) * near;
  colour = glm::mix(colour, vec3(0.70f, 0.45f, 0.41f), 0.55f * wet);
  const float edge = Bump(ball - 1.41f, 0.045f) * near;
  const float upper = Smoothstep(-0.1f, 0.25f, eye.y);
  const float shade = Bump(ball - 1.47f, 0.10f) * near * upper;  // shadow of the lashes on the lid
  const float lash = glm::mix(0.25f, 0.75f, upper) * edge + 0.22f * shade;
  colour = glm::mix(colour, vec3(0.20f, 0.11f, 0.09f), std::min(lash, 0.85f));
  const float caruncle = Spot(q, {kInnerCanthusX + 0.08f, -0.1f, 8.0f}, {0.20f, 0.2f, 0.6f});
  return glm::mix(colour, vec3(0.76f, 0.42f, 0.38f), 0.6f * caruncle);
}

// The roots of the hair. Single hairs form the hairline, combed up over the forehead and back at
// the temples. Cap and locks begin behind it.
vec3 Roots(const vec3& colour, const vec3& p, const vec3& hair) {
  const float inside = InsideHairline(p);
  if (inside < -1.2f) return colour;
  const float temple = Smoothstep(4.2f, 6.0f, std::abs(p.x));
  const float across = glm::mix(p.x + 0.35f * p.y, 0.9f * p.y + 0.4f * p.z, temple);
  const float along = glm::mix(p.y, p.z, temple);
  const float hairs = 0.45f * SignedNoise({11.0f * across, 1.2f * along, 2.0f}) +
                      0.30f * SignedNoise({24.0f * across, 2.0f * along, 7.0f});
  const float ear = Smoothstep(7.3f, 8.1f, std::abs(p.x)) * Smoothstep(2.3f, 1.7f, p.y) *
                    Smoothstep(0.6f, 0.2f, p.z);
  const float share = Smoothstep(-0.45f, 0.55f, inside + hairs) * (1.0f - ear);
  return glm::mix(colour, hair * (1.0f + 0.35f * hairs), 0.96f * share);
}

glm::vec4 HeadColour(const SurfaceTexel& texel, const FaceParameters& face) {
  const vec3 p = ModelToHead(texel.position);
  vec3 colour = BareSkin(p, texel.normal, face);
  colour = Lips(colour, p, face);
  colour = LidRims(colour, p);
  const vec3 dark =
      glm::mix(vec3(0.15f, 0.10f, 0.07f), vec3(0.48f, 0.46f, 0.44f), 0.75f * GreyShare(face));
  colour = glm::mix(colour, dark, 0.88f * BrowShare(p, face));
  return {Roots(colour, p, 1.3f * dark), 1.0f};
}

// The landmarks of the face do not apply to hands.
glm::vec4 HandColour(const SurfaceTexel& texel) {
  const vec3 p = texel.position * 100.0f;
  const float tip = Smoothstep(84.0f, 87.0f, std::abs(p.x));
  const vec3 colour = glm::mix(vec3(0.785f, 0.60f, 0.50f), vec3(0.79f, 0.51f, 0.44f), 0.5f * tip);
  return {colour * (1.0f + 0.04f * FractalNoise(p * 0.8f)), 1.0f};
}

// Gums and darkness behind the line of the lips: 0 outside, 1 deep inside.
float InsideMouth(const vec3& p, const HeadShape& shape) {
  if (std::abs(p.x) > 2.7f || std::abs(p.y - kMouthY) > 1.6f || p.z < 0.0f) return 0.0f;
  const float depth = -shape.Distance(p);
  return depth < 0.22f ? 0.0f : Smoothstep(-0.6f, 1.2f, depth);
}

}  // namespace

character::Picture PaintSkinColour(const character::Mesh& skin, const HeadShape& shape, int size) {
  return FillPicture(
      "skin_colour", RasterizeSurface(skin, size, size), size, 3,
      [&shape](const SurfaceTexel& texel) -> glm::vec4 {
        if (OnHand(texel)) return HandColour(texel);
        const float deep = InsideMouth(ModelToHead(texel.position), shape);
        if (deep <= 0.0f) return HeadColour(texel, shape.face());
        return {glm::mix(vec3(0.64f, 0.32f, 0.30f), vec3(0.42f, 0.16f, 0.14f), deep), 1.0f};
      });
}

}  // namespace furrow::authoring

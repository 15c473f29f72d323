// SPDX-License-Identifier: Apache-2.0
#include "character/generator/textures.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "character/generator/head_mesh.h"
#include "character/generator/head_shape.h"
#include "character/generator/mesh_tools.h"
#include "character/paint/canvas.h"
#include "character/paint/strokes.h"
#include "character/paint/uv_raster.h"

namespace furrow::character::generator {
namespace {

using glm::vec2;
using glm::vec3;
using glm::vec4;
using paint::Texel;

constexpr int kDilation = 6;  // texels around islands

Picture Paint(const char* name, const std::vector<Texel>& texels, int width, int height,
              int channels, const std::function<vec4(const Texel&)>& colour) {
  Picture picture = paint::BlankPicture(name, width, height, channels);
  for (const Texel& texel : texels) {
    const vec4 value = colour(texel);
    std::uint8_t* out = paint::TexelAt(&picture, texel.x, texel.y);
    for (int c = 0; c < channels; ++c) out[c] = paint::ToByte(value[c]);
  }
  paint::Dilate(&picture, texels, kDilation);
  return picture;
}

// 1 at the centre of an ellipsoid, 0 from twice its radii on (head space).
float Spot(const vec3& p, const vec3& centre, const vec3& radii) {
  const vec3 d = (p - centre) / radii;
  return std::exp(-glm::dot(d, d));
}

vec3 Mirrored(const vec3& p) { return {std::abs(p.x), p.y, p.z}; }

// Vermilion: between the borders of the lips (by height over the mouth's line) in front.
float LipShare(const vec3& p) {
  const float x = std::abs(p.x);
  const float reach = 1.0f - std::pow(std::min(x / 2.72f, 1.0f), 2.0f);
  const float bow = 0.09f * Bump(x - 0.62f, 0.38f) - 0.07f * Bump(x, 0.22f);
  const float top = kMouthY + 0.74f * std::pow(reach, 0.85f) + bow * reach;
  const float bottom = kMouthY - 0.88f * std::pow(reach, 0.7f);
  const float ragged = 0.02f * Noise(p * 9.0f);
  const float edge = 0.07f;
  return SmoothStep(top + edge, top - edge, p.y + ragged) *
         SmoothStep(bottom - edge, bottom + edge, p.y + ragged) * SmoothStep(2.8f, 2.5f, x) *
         SmoothStep(5.0f, 6.5f, p.z);
}

float BrowShare(const vec3& p) {
  const vec3 q = Mirrored(p);
  constexpr Knot kLine[] = {
      {0.9f, 1.78f}, {2.0f, 1.98f}, {3.4f, 2.16f}, {4.3f, 2.03f}, {5.4f, 1.42f}};
  constexpr Knot kHeight[] = {
      {0.85f, 0.15f}, {1.3f, 0.36f}, {2.6f, 0.34f}, {4.2f, 0.24f}, {5.5f, 0.04f}};
  if (q.x < 0.6f || q.x > 5.8f || q.z < 3.0f) return 0.0f;
  const float d = (q.y - Interpolate(kLine, q.x)) / Interpolate(kHeight, q.x);
  // Hairs slant outward, up at the inner end and along the line farther out.
  const float slant = q.x < 1.8f ? 0.9f : 0.25f;
  const float hair =
      Noise({(q.x - q.y * slant) * 16.0f, q.y * 3.5f + q.x * 1.2f, p.x > 0 ? 1.0f : 9.0f});
  const float body = SmoothStep(1.5f, 0.7f, std::abs(d) + 0.45f * hair);
  return body * SmoothStep(0.75f, 1.2f, q.x) * SmoothStep(5.7f, 4.9f, q.x);
}

// Where a beard would grow.
float BeardShare(const vec3& p) {
  const vec3 q = Mirrored(p);
  const float jaw =
      SmoothStep(-5.2f, -7.8f, q.y + 0.24f * (8.0f - q.z)) * SmoothStep(-14.0f, -11.5f, q.y);
  const float lip = Spot(q, {1.0f, -5.6f, 9.4f}, {1.6f, 0.6f, 2.0f});
  return std::max(jaw * SmoothStep(-2.5f, 0.5f, q.z), lip) * SmoothStep(10.3f, 9.8f, q.z);
}

vec3 SkinColour(const vec3& p, const vec3& normal) {
  const vec3 q = Mirrored(p);
  vec3 colour(0.80f, 0.615f, 0.52f);
  const float blotch = FractalNoise(p * 0.9f);
  const float fine = FractalNoise(p * 6.0f);
  const float red =
      0.85f * Spot(q, {4.3f, -3.1f, 7.0f}, {1.9f, 1.6f, 3.0f}) +
      0.75f * Spot(q, {0.0f, -3.8f, 11.0f}, {1.3f, 1.1f, 1.6f}) +
      0.35f * Spot(q, {0.0f, -10.0f, 9.3f}, {1.6f, 1.1f, 2.0f}) +
      0.5f * Spot(q, {1.5f, -4.3f, 9.5f}, {0.9f, 0.8f, 1.2f}) +
      0.3f * SmoothStep(6.6f, 7.6f, q.x) * SmoothStep(3.0f, 1.0f, std::abs(q.y + 1.5f));
  colour = glm::mix(colour, vec3(0.80f, 0.47f, 0.40f),
                    std::clamp(red * (0.55f + 0.3f * blotch), 0.0f, 0.6f));
  const float yellow = Spot(q, {0, 5.0f, 8.5f}, {5.0f, 2.6f, 4.0f});
  colour = glm::mix(colour, vec3(0.83f, 0.65f, 0.53f), 0.5f * yellow);
  // Round the eyes: thinner, cooler, darker skin.
  const float socket = Spot(q, {3.1f, -0.75f, 8.2f}, {1.7f, 0.7f, 2.0f}) +
                       0.7f * Spot(q, {1.9f, 0.6f, 8.3f}, {1.0f, 0.8f, 1.6f});
  colour = glm::mix(colour, vec3(0.62f, 0.44f, 0.40f), std::clamp(0.45f * socket, 0.0f, 0.6f));
  const float stubble = BeardShare(p) * (0.55f + 0.45f * Noise(p * 14.0f));
  colour = glm::mix(colour, vec3(0.45f, 0.37f, 0.34f), 0.30f * std::max(stubble, 0.0f));
  colour *= 1.0f + 0.035f * blotch + 0.03f * fine;
  // Freckles and a mole.
  const float freckle =
      SmoothStep(0.55f, 0.75f, Noise(p * 9.0f)) * Spot(q, {2.6f, -2.4f, 8.5f}, {3.2f, 1.6f, 3.5f});
  colour = glm::mix(colour, vec3(0.55f, 0.36f, 0.27f), 0.16f * freckle);
  colour = glm::mix(colour, vec3(0.30f, 0.19f, 0.15f),
                    0.8f * SmoothStep(0.16f, 0.1f, glm::distance(p, vec3(-3.3f, -5.6f, 8.15f))));
  // Nostrils are dark inside.
  const float nostril =
      Spot(q, {0.65f, -4.35f, 9.75f}, {0.30f, 0.38f, 0.5f}) * SmoothStep(0.1f, -0.5f, normal.y);
  colour = glm::mix(colour, vec3(0.22f, 0.09f, 0.07f), std::clamp(1.3f * nostril, 0.0f, 0.9f));
  return colour;
}

vec4 HeadColour(const Texel& texel) {
  const vec3 p = ModelToHead(texel.position);
  vec3 colour = SkinColour(p, texel.normal);
  const vec3 q = Mirrored(p);
  const float lips = LipShare(p);
  const float lip_lines = 0.05f * Noise({p.x * 11.0f, p.y * 1.6f, 5.0f});
  colour = glm::mix(colour, vec3(0.70f, 0.37f, 0.345f) * (1.0f + lip_lines), 0.82f * lips);
  const float line =
      Bump(p.y - kMouthY, 0.06f) * SmoothStep(2.9f, 2.4f, q.x) * SmoothStep(5.0f, 7.0f, p.z);
  colour = glm::mix(colour, vec3(0.34f, 0.13f, 0.12f), 0.65f * line);
  // Edges of the lids: wet and pink by the ball, dark where the lashes grow.
  const vec3 eye = q - vec3(kEyeCentre);
  const float ball = glm::length(eye);
  const float rim = SmoothStep(1.38f, 1.27f, ball) * SmoothStep(1.75f, 1.55f, std::abs(eye.x));
  colour = glm::mix(colour, vec3(0.62f, 0.33f, 0.30f), 0.55f * rim);
  const float caruncle = Spot(q, {kInnerCanthusX + 0.1f, -0.1f, 7.6f}, {0.22f, 0.22f, 0.6f});
  colour = glm::mix(colour, vec3(0.78f, 0.42f, 0.38f), 0.7f * caruncle);
  colour = glm::mix(colour, vec3(0.13f, 0.085f, 0.06f), 0.78f * BrowShare(p));
  const float stubble = SmoothStep(-0.7f, 0.5f, InsideHairline(p)) * SmoothStep(7.9f, 7.2f, q.x);
  colour = glm::mix(colour, vec3(0.20f, 0.14f, 0.11f), 0.75f * stubble);
  return vec4(colour, 1.0f);
}

// Hands share the atlas; the face's landmarks mean nothing there.
vec4 HandColour(const Texel& texel) {
  const vec3 p = texel.position * 100.0f;
  const float tip = SmoothStep(84.0f, 87.0f, std::abs(p.x));
  const vec3 colour = glm::mix(vec3(0.80f, 0.605f, 0.51f), vec3(0.80f, 0.52f, 0.45f), 0.5f * tip);
  return vec4(colour * (1.0f + 0.04f * FractalNoise(p * 0.8f)), 1.0f);
}

bool OnHand(const Texel& texel) { return std::abs(texel.position.x) > 0.4f; }

// What lies behind the lips' line: gums and dark.
bool InMouth(const vec3& p) {
  return std::abs(p.x) < 2.6f && std::abs(p.y - kMouthY) < 1.3f && p.z > 0.0f &&
         HeadDistance(p) < -0.22f;
}

}  // namespace

Picture PaintSkinColour(const Mesh& skin, int size) {
  return Paint("skin_colour", paint::RasterizeUv(skin, size, size), size, size, 3,
               [](const Texel& texel) -> vec4 {
                 if (OnHand(texel)) return HandColour(texel);
                 const vec3 p = ModelToHead(texel.position);
                 if (!InMouth(p)) return HeadColour(texel);
                 const float deep = SmoothStep(-0.2f, -1.2f, HeadDistance(p));
                 return vec4(glm::mix(vec3(0.42f, 0.17f, 0.16f), vec3(0.10f, 0.03f, 0.03f), deep),
                             1);
               });
}

Picture PaintSkinNormals(const Mesh& skin, int size) {
  const std::vector<Texel> texels = paint::RasterizeUv(skin, size, size);
  const auto height = [](const vec3& p) {  // centimetres
    const vec3 q = Mirrored(p);
    const float coarse = 0.4f + 0.8f * (Spot(q, {0, -3.6f, 10.6f}, {1.6f, 1.4f, 2.0f}) +
                                        Spot(q, {3.0f, -3.4f, 8.0f}, {2.0f, 1.8f, 3.0f}) +
                                        0.5f * Spot(q, {0, 4.5f, 9.0f}, {4.0f, 2.0f, 3.0f}));
    const float pores = Noise(p * 9.0f) + 0.6f * Noise(p * 17.0f + 5.0f);
    const float lips = LipShare(p);
    const float creases = Noise({p.x * 7.0f, p.y * 1.2f, 2.0f});
    return 0.0035f * coarse * pores * (1.0f - lips) + 0.006f * lips * creases;
  };
  std::vector<vec2> slopes;
  slopes.reserve(texels.size());
  constexpr float kStep = 0.03f;
  for (const Texel& texel : texels) {
    const vec3 p = ModelToHead(texel.position);
    const float here = height(p);
    slopes.emplace_back((here - height(p + texel.tangent * kStep)) / kStep,
                        (here - height(p + texel.bitangent * kStep)) / kStep);
  }
  Picture picture = paint::EncodeNormals(texels, slopes, size, size);
  picture.name = "skin_normal";
  return picture;
}

Picture PaintEyes(int size) {
  Picture picture = paint::BlankPicture("eye_colour", 2 * size, size, 3);
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < 2 * size; ++x) {
      const vec2 uv((static_cast<float>(x % size) + 0.5f) / static_cast<float>(size) - 0.5f,
                    (static_cast<float>(y) + 0.5f) / static_cast<float>(size) - 0.5f);
      const float degrees = glm::length(uv) / 0.48f * 112.0f;
      const float turn = std::atan2(uv.y, uv.x);
      const vec3 around(std::cos(turn), std::sin(turn), x < size ? 0.0f : 7.0f);
      const float fibre =
          Noise(around * 22.0f + vec3(0, 0, degrees * 0.05f)) + 0.5f * Noise(around * 41.0f);
      const float vein =
          SmoothStep(0.72f, 0.95f, 1.0f - std::abs(FractalNoise(vec3(uv * 26.0f, 3.0f)))) *
          SmoothStep(38.0f, 62.0f, degrees);
      vec3 colour = glm::mix(vec3(0.80f, 0.77f, 0.74f), vec3(0.76f, 0.60f, 0.56f),
                             SmoothStep(45, 75, degrees));
      colour = glm::mix(colour, vec3(0.72f, 0.32f, 0.28f), 0.35f * vein);
      vec3 iris = glm::mix(vec3(0.36f, 0.24f, 0.12f), vec3(0.20f, 0.27f, 0.24f),
                           SmoothStep(13, 22, degrees));
      iris *= 1.0f + 0.35f * fibre;
      iris = glm::mix(iris, vec3(0.06f, 0.06f, 0.06f), SmoothStep(23.0f, 29.0f, degrees));
      colour = glm::mix(iris, colour, SmoothStep(27.0f, 30.5f, degrees));
      colour = glm::mix(vec3(0.012f), colour, SmoothStep(9.5f, 11.5f, degrees));
      std::uint8_t* out = paint::TexelAt(&picture, x, y);
      for (int c = 0; c < 3; ++c) out[c] = paint::ToByte(colour[c]);
    }
  }
  return picture;
}

Picture PaintHairColour(const Mesh& hair, int size) {
  return Paint("hair_colour", paint::RasterizeUv(hair, size, size), size, size, 3,
               [](const Texel& texel) {
                 const vec3 p = ModelToHead(texel.position);
                 // Combed back and to the sides: strands follow the direction away from the brow.
                 const float across = std::atan2(p.x, p.y + 2.0f) * 9.0f;
                 const float strand = 0.6f * Noise({across * 6.0f, p.z * 0.6f, p.y * 0.5f}) +
                                      0.4f * Noise({across * 15.0f, p.z * 0.9f, 4.0f});
                 const vec3 colour = vec3(0.17f, 0.115f, 0.08f) * (1.0f + 0.55f * strand);
                 // Skin shines through where the hair begins, between some strands farther in.
                 const float thick = SmoothStep(0.2f, 1.1f, InsideHairline(p) + 0.5f * strand);
                 return vec4(glm::mix(vec3(0.40f, 0.29f, 0.235f), colour, thick), 1.0f);
               });
}

Picture PaintClothColour(const Mesh& clothes, int size) {
  const float half =
      0.5f * static_cast<float>(size);  // sleeves and torso lie above, trousers below
  return Paint("cloth_colour", paint::RasterizeUv(clothes, size, size), size, size, 3,
               [half](const Texel& texel) {
                 const vec3 p = texel.position * 100.0f;
                 const bool trousers = static_cast<float>(texel.y) > half;
                 // Warp and weft are a texel or two wide: a hint, not a moire.
                 const float weave =
                     Hash(texel.x / 2, 0, trousers) + Hash(0, texel.y / 2, trousers) - 1.0f;
                 const float worn = FractalNoise(p * 0.12f);
                 vec3 colour = trousers ? vec3(0.29f, 0.30f, 0.335f) : vec3(0.34f, 0.41f, 0.47f);
                 colour *= 1.0f + 0.07f * weave + 0.06f * worn;
                 const float placket =
                     trousers ? 0.0f : Bump(std::abs(p.x) - 1.6f, 0.12f) * SmoothStep(2, 6, p.z);
                 const float hem = trousers ? Bump(p.y - 9.6f, 0.15f) : Bump(p.y - 91.5f, 0.15f);
                 return vec4(colour * (1.0f - 0.35f * std::max(placket, hem)), 1.0f);
               });
}

namespace {

struct Blob {
  vec3 centre;  // head space
  vec3 radii;
};

float Soft(const vec3& p, std::initializer_list<Blob> blobs) {
  float mask = 0.0f;
  for (const Blob& blob : blobs) {
    const float d = glm::length((p - blob.centre) / blob.radii);
    mask = std::max(mask, SmoothStep(1.0f, 0.45f, d));
  }
  return mask;
}

// Share of the left side at x, blending over the middle.
float LeftShare(float x) { return SmoothStep(-0.8f, 0.8f, x); }

Picture PaintMasks(const char* name, const Mesh& skin, int size,
                   const std::function<vec4(const vec3&)>& regions) {
  return Paint(name, paint::RasterizeUv(skin, size, size), size, size, 4, [&](const Texel& texel) {
    const vec3 p = ModelToHead(texel.position);
    if (OnHand(texel) || p.z < 0.0f) return vec4(0.0f);
    return regions(p) * SmoothStep(0.0f, 2.0f, p.z);
  });
}

}  // namespace

Picture PaintMasksA(const Mesh& skin, int size) {
  return PaintMasks("face_masks_a", skin, size, [](const vec3& p) {
    const vec3 q = Mirrored(p);
    const float brow = Soft(q, {{{3.0f, 4.6f, 8.0f}, {5.2f, 3.6f, 6.0f}}});
    const float glabella = Soft(q, {{{0.0f, 1.7f, 9.5f}, {1.9f, 2.3f, 3.0f}}});
    const float nose =
        Soft(q, {{{0.0f, -2.0f, 10.0f}, {2.3f, 3.0f, 3.5f}}}) * (1.0f - 0.7f * glabella);
    return vec4(brow * LeftShare(p.x), brow * (1.0f - LeftShare(p.x)), glabella, nose);
  });
}

Picture PaintMasksB(const Mesh& skin, int size) {
  return PaintMasks("face_masks_b", skin, size, [](const vec3& p) {
    const vec3 q = Mirrored(p);
    const float eye = Soft(q, {{{4.2f, -0.2f, 7.2f}, {3.4f, 2.6f, 4.5f}}});
    const float mouth = Soft(
        q, {{{1.8f, -7.0f, 8.5f}, {4.4f, 4.2f, 6.0f}}, {{1.5f, -10.0f, 8.0f}, {3.6f, 2.6f, 5.0f}}});
    return vec4(eye * LeftShare(p.x), eye * (1.0f - LeftShare(p.x)), mouth * LeftShare(p.x),
                mouth * (1.0f - LeftShare(p.x)));
  });
}

}  // namespace furrow::character::generator

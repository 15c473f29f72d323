// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/textures/textures.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "authoring/generator/head/face_parts.h"
#include "authoring/generator/head/hair_style.h"
#include "authoring/generator/head/head_shape.h"
#include "authoring/generator/mesh/mesh_tools.h"
#include "authoring/generator/textures/skin_regions.h"
#include "authoring/paint/canvas.h"
#include "authoring/paint/hair_strands.h"
#include "authoring/paint/noise.h"
#include "authoring/paint/surface_texels.h"
#include "base/scalar.h"
#include "base/srgb.h"

namespace furrow::authoring {
namespace {

using glm::vec2;
using glm::vec3;
using glm::vec4;

// The cap, which has texels of its own. The strands above it share theirs.
character::Mesh CapOf(const character::Mesh& hair) {
  character::Mesh cap = hair;
  cap.indices.clear();
  for (std::size_t i = 0; i + 2 < hair.indices.size(); i += 3) {
    if (hair.vertices[hair.indices[i]].uv.y < kStrandBottom) continue;
    cap.indices.insert(cap.indices.end(), &hair.indices[i], &hair.indices[i] + 3);
  }
  return cap;
}

}  // namespace

character::Picture PaintEyes(int size) {
  character::Picture picture = BlankPicture("eye_colour", 2 * size, size, 3);
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < 2 * size; ++x) {
      const vec2 uv((static_cast<float>(x % size) + 0.5f) / static_cast<float>(size) - 0.5f,
                    (static_cast<float>(y) + 0.5f) / static_cast<float>(size) - 0.5f);
      const float degrees = glm::length(uv) / 0.48f * 112.0f;
      const float turn = std::atan2(uv.y, uv.x);
      const vec3 around(std::cos(turn), std::sin(turn), x < size ? 0.0f : 7.0f);
      const float fibre = SignedNoise(around * 22.0f + vec3(0, 0, degrees * 0.05f)) +
                          0.5f * SignedNoise(around * 41.0f);
      const float vein =
          Smoothstep(0.72f, 0.95f, 1.0f - std::abs(FractalNoise(vec3(uv * 26.0f, 3.0f)))) *
          Smoothstep(38.0f, 62.0f, degrees);
      vec3 colour = glm::mix(vec3(0.87f, 0.85f, 0.82f), vec3(0.78f, 0.62f, 0.58f),
                             Smoothstep(45, 75, degrees));
      colour = glm::mix(colour, vec3(0.72f, 0.32f, 0.28f), 0.35f * vein);
      vec3 iris = glm::mix(vec3(0.36f, 0.24f, 0.12f), vec3(0.20f, 0.27f, 0.24f),
                           Smoothstep(13, 22, degrees));
      iris *= 1.0f + 0.35f * fibre;
      iris = glm::mix(iris, vec3(0.06f, 0.06f, 0.06f), Smoothstep(23.0f, 29.0f, degrees));
      colour = glm::mix(iris, colour, Smoothstep(26.5f, 29.5f, degrees));
      colour = glm::mix(vec3(0.012f), colour, Smoothstep(9.5f, 11.5f, degrees));
      SetTexel(&picture, x, y, glm::vec4(colour, 1.0f));
    }
  }
  return picture;
}

character::Picture PaintLash() {
  constexpr int kWidth = 32, kHeight = 16;  // seen from the front, it is short
  character::Picture picture = BlankPicture("lash", kWidth, kHeight, 4);
  for (int y = 0; y < kHeight; ++y) {
    const float t = (static_cast<float>(y) + 0.5f) / static_cast<float>(kHeight);
    const float half = 0.36f * (1.0f - 0.5f * std::pow(t, 1.4f));
    for (int x = 0; x < kWidth; ++x) {
      const float across = std::abs(2.0f * (static_cast<float>(x) + 0.5f) / kWidth - 1.0f);
      const float alpha = Smoothstep(half + 0.06f, half - 0.06f, across);
      SetTexel(&picture, x, y, glm::vec4(glm::vec3(1.0f), alpha));
    }
  }
  return picture;
}

character::Picture PaintLidShade() {
  // The lids reflect reddish light into their own shadow.
  constexpr vec3 kDarkest(0.42f, 0.33f, 0.30f);  // linear
  constexpr int kHeight = 64;
  character::Picture picture = BlankPicture("lid_shade", 1, kHeight, 3);
  for (int y = 0; y < kHeight; ++y) {
    const float v = (static_cast<float>(y) + 0.5f) / kHeight;
    const float light = Smoothstep(0.2f, 0.75f, v);
    const vec3 passes = glm::mix(kDarkest, vec3(1.0f), light);
    const vec3 bytes(SrgbFromLinear(passes.r), SrgbFromLinear(passes.g), SrgbFromLinear(passes.b));
    SetTexel(&picture, 0, y, vec4(bytes, 1.0f));
  }
  return picture;
}

HairPictures PaintHair(const character::Mesh& hair, const FaceParameters& face, int size) {
  StrandLook look;
  look.grey_share = GreyShare(face);
  const vec3 shade = 0.75f * glm::mix(look.colour, look.grey, look.grey_share);
  HairPictures pictures;
  pictures.colour =
      FillPicture("hair_colour", RasterizeSurface(CapOf(hair), size, size), size, 4,
                  [&shade](const SurfaceTexel& texel) -> vec4 {
                    const vec3 p = ModelToHead(texel.position);
                    const float grain = SignedNoise(p * 9.0f) + 0.5f * SignedNoise(p * 19.0f);
                    // The edge of the cap is uneven but has no islands, which would be specks.
                    const float inside = InsideHairline(p) + 0.4f * SignedNoise(p * 3.0f);
                    return {shade * (1.0f + 0.15f * grain), Smoothstep(0.8f, 1.9f, inside)};
                  });
  pictures.normals = BlankPicture("hair_normal", size, size, 3);
  for (std::size_t i = 0; i < pictures.normals.pixels.size(); ++i) {
    pictures.normals.pixels[i] = i % 3 == 2 ? 255 : 128;
  }
  PaintStrands(look, &pictures.colour, &pictures.normals);
  return pictures;
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
    mask = std::max(mask, Smoothstep(1.0f, 0.45f, d));
  }
  return mask;
}

// The share of the left side at x, blended across the middle.
float LeftShare(float x) { return Smoothstep(-0.8f, 0.8f, x); }

character::Picture PaintMasks(const char* name, const character::Mesh& skin, int size,
                              const std::function<vec4(const vec3&)>& regions) {
  return FillPicture(name, RasterizeSurface(skin, size, size), size, 4,
                     [&](const SurfaceTexel& texel) {
                       const vec3 p = ModelToHead(texel.position);
                       if (OnHand(texel) || p.z < 0.0f) return vec4(0.0f);
                       return regions(p) * Smoothstep(0.0f, 2.0f, p.z);
                     });
}

}  // namespace

character::Picture PaintMasksA(const character::Mesh& skin, int size) {
  return PaintMasks("face_masks_a", skin, size, [](const vec3& p) {
    const vec3 q = OnLeftSide(p);
    const float brow = Soft(q, {{{3.0f, 4.6f, 8.0f}, {5.2f, 3.6f, 6.0f}}});
    const float glabella = Soft(q, {{{0.0f, 1.7f, 9.5f}, {1.9f, 2.3f, 3.0f}}});
    const float nose =
        Soft(q, {{{0.0f, -2.0f, 10.0f}, {2.3f, 3.0f, 3.5f}}}) * (1.0f - 0.7f * glabella);
    return vec4(brow * LeftShare(p.x), brow * (1.0f - LeftShare(p.x)), glabella, nose);
  });
}

character::Picture PaintMasksB(const character::Mesh& skin, int size) {
  return PaintMasks("face_masks_b", skin, size, [](const vec3& p) {
    const vec3 q = OnLeftSide(p);
    const float eye = Soft(q, {{{4.2f, -0.2f, 7.2f}, {3.4f, 2.6f, 4.5f}},
                               {{3.2f, 1.0f, 8.6f}, {2.5f, 1.5f, 2.8f}}});  // the upper lid
    const float mouth =
        Soft(q, {{{1.8f, -7.0f, 8.5f}, {4.4f, 4.2f, 6.0f}},
                 {{1.5f, -10.0f, 8.0f}, {3.6f, 2.6f, 5.0f}},
                 {{2.5f, -4.4f, 8.5f}, {2.0f, 2.6f, 5.0f}},     // up along the nasolabial fold
                 {{2.8f, -14.8f, 2.4f}, {3.4f, 4.0f, 4.5f}}});  // the neck bands
    return vec4(eye * LeftShare(p.x), eye * (1.0f - LeftShare(p.x)), mouth * LeftShare(p.x),
                mouth * (1.0f - LeftShare(p.x)));
  });
}

}  // namespace furrow::authoring

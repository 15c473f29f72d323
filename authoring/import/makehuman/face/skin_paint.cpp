// SPDX-License-Identifier: Apache-2.0
#include "authoring/import/makehuman/face/skin_paint.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "authoring/import/makehuman/face/polyline.h"
#include "authoring/paint/canvas.h"
#include "authoring/paint/noise.h"

namespace furrow::authoring {
namespace {

// sRGB in [0, 1]. Skin looks alive because of the differences between its regions.
constexpr glm::vec3 kSkin{0.80f, 0.615f, 0.52f};
constexpr glm::vec3 kRed{0.77f, 0.48f, 0.42f};
constexpr glm::vec3 kYellow{0.82f, 0.66f, 0.54f};
constexpr glm::vec3 kLips{0.67f, 0.40f, 0.38f};
constexpr glm::vec3 kLids{0.70f, 0.51f, 0.45f};
constexpr glm::vec3 kMouth{0.25f, 0.09f, 0.085f};
constexpr glm::vec3 kBrow{0.23f, 0.165f, 0.13f};
constexpr glm::vec3 kStubble{0.17f, 0.12f, 0.095f};

// How much a point belongs to the front of the face. This keeps features off the inside of the
// mouth, which is close behind the lips.
float Front(const SurfaceTexel& texel) { return glm::smoothstep(-0.1f, 0.35f, texel.normal.z); }

float Redness(const glm::vec3& p, const FaceLandmarks& face) {
  float red = 0.4f * FadeOut(glm::distance(p, face.nose_tip), 0.0f, face.Millimetres(22.0f));
  for (const FaceLandmarks::Side& side : face.sides) {
    const glm::vec3 apple = glm::mix(side.cheek, side.fold_top, 0.35f);
    red = std::max(red, 0.42f * FadeOut(glm::distance(p, apple), 0.0f, face.Millimetres(36.0f)));
    glm::vec3 ear = side.temple;  // ears are level with the temples, well behind them
    ear.z = face.head.z;
    red = std::max(red, 0.6f * FadeOut(glm::distance(p, ear), face.Millimetres(10.0f),
                                       face.Millimetres(40.0f)));
  }
  return red;
}

// The distance seen from the front, since lips and brows curve around the face.
float FrontDistance(glm::vec3 p, std::initializer_list<glm::vec3> line) {
  p.z = 0.0f;
  float nearest = 1.0f;
  for (const glm::vec3* a = line.begin(); a + 1 < line.end(); ++a) {
    nearest = std::min(nearest, DistanceToLine(p, {glm::vec3(a[0].x, a[0].y, 0.0f),
                                                   glm::vec3(a[1].x, a[1].y, 0.0f)}));
  }
  return nearest;
}

float Lips(const glm::vec3& p, const FaceLandmarks& face) {
  const glm::vec3 above = glm::mix(face.upper_lip, face.lower_lip, 0.4f);
  const glm::vec3 below = glm::mix(face.lower_lip, face.lower_lip_bottom, 0.25f);
  float amount = 0.0f;
  for (const FaceLandmarks::Side& side : face.sides) {
    const glm::vec3 corner = glm::mix(side.fold_bottom, side.mouth_corner, 0.4f);
    if (p.z < corner.z - face.Millimetres(8.0f)) continue;  // back of the head
    const float along =
        std::clamp(std::abs(p.x - above.x) / std::abs(corner.x - above.x), 0.0f, 1.0f);
    const float half = face.Millimetres(glm::mix(3.9f, 0.9f, along * along));
    const float distance =
        std::min(FrontDistance(p, {above, corner}), FrontDistance(p, {below, corner}));
    amount = std::max(amount, FadeOut(distance, 0.75f * half, 1.35f * half));
  }
  return amount;
}

// The hairs of a brow: noise that is stretched along them. Hairs stand up at the nose and lie down
// toward the temple. `out` and `up`: millimetres from the inner end; `along`: [0, 1] from there.
float BrowHairs(float out, float up, float along) {
  const float rise = glm::mix(1.2f, 0.15f, glm::smoothstep(0.0f, 0.35f, along));
  const glm::vec2 hair(std::cos(rise), std::sin(rise));
  const float length = out * hair.x + up * hair.y;
  const float across = up * hair.x - out * hair.y;
  const float thick = ValueNoise({length / 5.0f, across / 0.55f, 1.5f});
  const float fine = ValueNoise({length / 3.0f, across / 0.32f, 7.5f});
  return glm::smoothstep(0.30f, 0.62f, 0.6f * thick + 0.4f * fine);
}

float Brow(const glm::vec3& p, const FaceLandmarks& face) {
  float amount = 0.0f;
  for (const FaceLandmarks::Side& side : face.sides) {
    if (p.z < side.temple.z) continue;
    glm::vec3 inner = side.brow_inner, arch = side.brow_middle;
    glm::vec3 end = glm::mix(side.brow_middle, side.brow_outer, 0.8f);
    inner.y -= face.Millimetres(3.0f);
    arch.y += face.Millimetres(1.0f);
    end.y = glm::mix(arch.y, end.y, 0.4f);
    const float distance = FrontDistance(p, {inner, arch, end});
    // Thick at the nose, thin at the temple, and ragged, so that single hairs show.
    const float along = std::clamp((p.x - inner.x) / (end.x - inner.x), 0.0f, 1.0f);
    const float millimetre = face.Millimetres(1.0f);
    const float hairs =
        BrowHairs(std::abs(p.x - inner.x) / millimetre, (p.y - inner.y) / millimetre, along);
    const float half = millimetre * glm::mix(4.2f, 1.3f, along) * (0.6f + 0.75f * hairs);
    const float inside = FadeOut(distance, 0.35f * half, 1.25f * half);
    amount = std::max(amount, inside * (0.35f + 0.65f * hairs));
  }
  return amount;
}

// The inside of the mouth: a ball behind the lips. In flat faces, such as a child's, it reaches
// through the cheeks, which face away from its centre.
float MouthInside(const SurfaceTexel& texel, const FaceLandmarks& face) {
  glm::vec3 middle = glm::mix(face.upper_lip, face.lower_lip, 0.5f);
  middle.z -= face.Millimetres(36.0f);
  const glm::vec3 out = texel.position - middle;
  const float distance = glm::length(out);
  const float outward = glm::dot(out, texel.normal) / std::max(distance, 1e-6f);
  return FadeOut(distance, face.Millimetres(27.0f), face.Millimetres(34.0f)) *
         glm::smoothstep(0.75f, 0.25f, outward);
}

float ScalpOf(const glm::vec3& p, const FaceLandmarks& face) {
  const float aside = std::min(std::abs(p.x) / face.Millimetres(62.0f), 1.5f);
  const float hairline = glm::mix(face.sides[0].brow_middle.y, face.crown.y, 0.62f) -
                         face.Millimetres(26.0f) * aside * aside;
  const float back = face.sides[0].temple.z - face.Millimetres(8.0f);
  const float top =
      glm::smoothstep(hairline - face.Millimetres(5.0f), hairline + face.Millimetres(8.0f), p.y);
  const float ear = face.sides[0].lower_lid.y;
  const float sides =
      glm::smoothstep(ear - face.Millimetres(18.0f), ear + face.Millimetres(10.0f), p.y) *
      glm::smoothstep(back, back - face.Millimetres(14.0f), p.z);
  return std::max(top, sides);
}

float LidShade(const glm::vec3& p, const FaceLandmarks& face) {
  float shade = 0.0f;
  for (const FaceLandmarks::Side& side : face.sides) {
    shade = std::max(shade, FadeOut(glm::distance(p, side.eye), face.Millimetres(14.0f),
                                    face.Millimetres(24.0f)));
  }
  return shade;
}

// The factors of an asian's and an african's skin, relative to kSkin.
glm::vec3 ToneOf(const SkinLook& look) {
  constexpr glm::vec3 kAsian{1.01f, 1.02f, 0.93f};
  constexpr glm::vec3 kAfrican{0.54f, 0.49f, 0.45f};
  return glm::vec3(1.0f) + look.asian * (kAsian - 1.0f) + look.african * (kAfrican - 1.0f);
}

// Old skin is paler and yellower, with spots on forehead and cheeks.
glm::vec3 Aged(const glm::vec3& colour, const glm::vec3& p, const FaceLandmarks& face, float old) {
  if (old <= 0.0f) return colour;
  constexpr glm::vec3 kPale{0.80f, 0.66f, 0.56f};
  constexpr glm::vec3 kSpot{0.60f, 0.43f, 0.32f};
  const float spots = glm::smoothstep(0.72f, 0.80f, ValueNoise(p / face.Millimetres(5.0f)));
  const float where = ValueNoise(p / face.Millimetres(26.0f) + glm::vec3(7.5f));
  const glm::vec3 pale = glm::mix(colour, kPale, 0.35f * old);
  return glm::mix(pale, kSpot, 0.45f * old * spots * glm::smoothstep(0.4f, 0.7f, where));
}

glm::vec3 SkinColour(const SurfaceTexel& texel, const FaceLandmarks& face, const SkinLook& look) {
  const glm::vec3& p = texel.position;
  const float blotches = ValueNoise(p / face.Millimetres(11.0f)) - 0.5f;
  const float speckle = ValueNoise(p / face.Millimetres(1.7f)) - 0.5f;
  glm::vec3 colour = kSkin;
  const float brow = face.sides[0].brow_middle.y, chin = face.lower_lip_bottom.y;
  const float soft = face.Millimetres(10.0f);
  const float yellow = glm::smoothstep(brow - soft, brow + soft, p.y) +
                       glm::smoothstep(chin + soft, chin - soft, p.y);
  colour = glm::mix(colour, kYellow, 0.5f * yellow);
  colour = glm::mix(colour, kRed, Redness(p, face) + 0.25f * blotches);
  const float front = Front(texel);
  colour = Aged(colour, p, face, look.old);
  colour = glm::mix(colour, kLids, 0.55f * LidShade(p, face) * front);
  colour = glm::mix(colour, kLips, Lips(p, face) * front);
  colour = glm::mix(colour, kMouth, MouthInside(texel, face));
  const float grain = ValueNoise(p / face.Millimetres(0.9f));
  colour *= ToneOf(look);
  if (look.scalp)
    colour = glm::mix(colour, HairColour(kStubble, look),
                      ScalpAmount(p, face) * (0.75f + 0.25f * grain));
  if (look.brows) colour = glm::mix(colour, HairColour(kBrow, look), 0.92f * Brow(p, face) * front);
  return colour * (1.0f + 0.05f * blotches + 0.05f * speckle);
}

// The weights of the eight regions at a point, before overlaps are resolved.
std::array<float, 8> RegionFields(const glm::vec3& p, const FaceLandmarks& face) {
  std::array<float, 8> field{};
  const auto mm = [&face](float v) { return face.Millimetres(v); };
  const float middle = 0.5f * (face.sides[0].eye.x + face.sides[1].eye.x);
  const float left = glm::smoothstep(-mm(9.0f), mm(9.0f), p.x - middle);
  const glm::vec3 between = 0.5f * (face.sides[0].brow_inner + face.sides[1].brow_inner);
  const float glabella = FadeOut(DistanceToLine(p, {between + glm::vec3(0.0f, mm(7.0f), 0.0f),
                                                    glm::mix(between, face.nose_bridge, 0.4f)}),
                                 mm(6.0f), mm(17.0f));
  const float nose =
      FadeOut(DistanceToLine(p, {face.nose_bridge, face.nose_tip}), mm(13.0f), mm(27.0f));
  const float brow_line = 0.5f * (face.sides[0].brow_middle.y + face.sides[1].brow_middle.y);
  const float hairline = glm::mix(brow_line, face.crown.y, 0.72f);
  for (std::size_t s = 0; s < 2; ++s) {
    const FaceLandmarks::Side& side = face.sides[s];
    const float half = s == 0 ? left : 1.0f - left;
    field[s] = half * glm::smoothstep(brow_line - mm(13.0f), brow_line + mm(3.0f), p.y) *
               glm::smoothstep(hairline + mm(8.0f), hairline - mm(10.0f), p.y) *
               glm::smoothstep(side.temple.z - mm(22.0f), side.temple.z + mm(4.0f), p.z);
    const glm::vec3 corner = glm::mix(side.eye, side.temple, 0.85f);
    field[4 + s] =
        half * FadeOut(DistanceToLine(p, {side.pupil, side.eye, corner}), mm(23.0f), mm(36.0f));
    field[6 + s] = half * FadeOut(DistanceToLine(p, {side.fold_top, side.fold_middle,
                                                     side.mouth_corner, side.chin_side, face.chin}),
                                  mm(24.0f), mm(40.0f));
  }
  field[2] = glabella;
  field[3] = nose * (1.0f - glabella);
  for (const std::size_t beside : {0u, 1u, 4u, 5u}) field[beside] *= 1.0f - glabella;
  for (const std::size_t beside : {4u, 5u, 6u, 7u}) field[beside] *= 1.0f - 0.8f * nose;
  return field;
}

}  // namespace

float ScalpAmount(const glm::vec3& p, const FaceLandmarks& face) {
  // Ears are behind the temples, below the brows.
  const FaceLandmarks::Side& side = face.sides[p.x > 0.0f ? 0 : 1];
  const glm::vec3 ear(1.1f * side.temple.x, side.eye.y - face.Millimetres(20.0f),
                      side.eye.z - face.Millimetres(86.0f));
  const float off_ear =
      1.0f - FadeOut(glm::distance(p, ear), face.Millimetres(30.0f), face.Millimetres(38.0f));
  return ScalpOf(p, face) * off_ear;
}

glm::vec3 HairColour(const glm::vec3& colour, const SkinLook& look) {
  constexpr glm::vec3 kGrey{0.60f, 0.58f, 0.56f};
  const glm::vec3 young = glm::mix(colour, 0.4f * colour, look.asian + look.african);
  // Light strands stay lighter than dark ones.
  const float light = 0.35f + 2.2f * (colour.r + colour.g + colour.b) / 3.0f;
  return glm::mix(young, kGrey * light, glm::smoothstep(0.35f, 0.95f, look.old));
}

character::Picture PaintMakeHumanSkin(const std::vector<SurfaceTexel>& texels,
                                      const FaceLandmarks& face, const SkinLook& look, int size) {
  character::Picture picture = BlankPicture("skin_colour", size, size, 3);
  for (const SurfaceTexel& texel : texels) {
    SetTexel(&picture, texel.x, texel.y, glm::vec4(SkinColour(texel, face, look), 1.0f));
  }
  Dilate(&picture, texels, kSeamTexels);
  return picture;
}

void PaintMakeHumanBrows(const std::vector<SurfaceTexel>& texels, const FaceLandmarks& face,
                         const SkinLook& look, character::Picture* picture) {
  if (!look.brows) return;
  const glm::vec3 brow = HairColour(kBrow, look);
  for (const SurfaceTexel& texel : texels) {
    const float amount = 0.92f * Brow(texel.position, face) * Front(texel);
    if (amount <= 0.0f) continue;
    std::uint8_t* out = TexelAt(picture, texel.x, texel.y);
    for (int c = 0; c < 3; ++c)
      out[c] = ToByte(glm::mix(static_cast<float>(out[c]) / 255.0f, brow[c], amount));
  }
}

character::Picture PaintMakeHumanSkinNormals(const std::vector<SurfaceTexel>& texels,
                                             const FaceLandmarks& face, int size) {
  const auto height = [&face](const glm::vec3& p) {
    // The magnitude of noise has sharp valleys, which look like the fine furrows between pores.
    const float net = std::abs(ValueNoise(p / face.Millimetres(1.6f)) - 0.5f);
    const float pores = ValueNoise(p / face.Millimetres(0.8f));
    return face.Millimetres(0.16f) * net + face.Millimetres(0.05f) * pores;
  };
  const float step = face.Millimetres(0.25f);
  character::Picture picture = BlankPicture("skin_normal", size, size, 3);
  for (std::size_t i = 0; i < picture.pixels.size(); ++i)
    picture.pixels[i] = i % 3 == 2 ? 255 : 128;
  for (const SurfaceTexel& texel : texels) {
    const auto slope = [&](const glm::vec3& along) {
      return (height(texel.position + along * step) - height(texel.position - along * step)) /
             (2.0f * step);
    };
    const glm::vec3 n =
        glm::normalize(glm::vec3(-slope(texel.tangent), -slope(texel.bitangent), 1.0f));
    SetTexel(&picture, texel.x, texel.y, glm::vec4(n * 0.5f + 0.5f, 1.0f));
  }
  Dilate(&picture, texels, kSeamTexels);
  return picture;
}

void AddRestFolds(const character::Picture& folds, float amount, character::Picture* normals) {
  for (int y = 0; y < normals->height; ++y) {
    for (int x = 0; x < normals->width; ++x) {
      const glm::vec2 uv((static_cast<float>(x) + 0.5f) / static_cast<float>(normals->width),
                         (static_cast<float>(y) + 0.5f) / static_cast<float>(normals->height));
      std::uint8_t* out = TexelAt(normals, x, y);
      glm::vec3 skin, fold;
      for (int c = 0; c < 3; ++c) {
        skin[c] = static_cast<float>(out[c]) / 127.5f - 1.0f;
        fold[c] = 2.0f * ChannelAt(folds, uv, c) - 1.0f;
      }
      // 128 of 255 is not quite flat.
      if (std::abs(fold.x) < 0.01f && std::abs(fold.y) < 0.01f) continue;
      const float up = std::max(fold.z, 0.1f);
      const glm::vec3 sum(skin.x / std::max(skin.z, 0.1f) + amount * fold.x / up,
                          skin.y / std::max(skin.z, 0.1f) + amount * fold.y / up, 1.0f);
      const glm::vec3 n = glm::normalize(sum);
      for (int c = 0; c < 3; ++c) out[c] = ToByte(n[c] * 0.5f + 0.5f);
    }
  }
}

FaceMasks PaintFaceMasks(const std::vector<SurfaceTexel>& texels, const FaceLandmarks& face,
                         int size) {
  FaceMasks masks{BlankPicture("face_masks_a", size, size, 4),
                  BlankPicture("face_masks_b", size, size, 4)};
  for (const SurfaceTexel& texel : texels) {
    std::array<float, 8> field = RegionFields(texel.position, face);
    float sum = 0.0f;
    for (const float value : field) sum += value;
    // Temples face sideways and still wrinkle. Surfaces that face backward do not.
    const float forward = glm::smoothstep(-0.5f, -0.1f, texel.normal.z);
    const float scale = forward / std::max(sum, 1.0f);
    std::uint8_t* first = TexelAt(&masks.first, texel.x, texel.y);
    std::uint8_t* second = TexelAt(&masks.second, texel.x, texel.y);
    for (std::size_t c = 0; c < 4; ++c) {
      first[c] = ToByte(field[c] * scale);
      second[c] = ToByte(field[4 + c] * scale);
    }
  }
  Dilate(&masks.first, texels, kSeamTexels);
  Dilate(&masks.second, texels, kSeamTexels);
  return masks;
}

}  // namespace furrow::authoring

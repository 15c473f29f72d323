// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/clothes/cloth_texture.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "authoring/generator/clothes/cloth_panels.h"
#include "authoring/generator/mesh/mesh_tools.h"
#include "authoring/paint/canvas.h"
#include "authoring/paint/noise.h"
#include "authoring/paint/strokes.h"
#include "authoring/paint/surface_texels.h"
#include "base/scalar.h"

namespace furrow::authoring {
namespace {

using glm::vec2;
using glm::vec3;

constexpr int kNormalBits = 8;

// The position of a texel on the cloth.
struct ClothPlace {
  int panel;
  vec2 cut;  // metres in the flat panel, along the weave
  vec3 p;    // metres, at rest
};

// Finds the place of a texel in its flat panel, so that weave and seams follow the cut of the
// cloth.
class ClothAtlas {
 public:
  ClothAtlas(const Clothes& clothes, int size)
      : clothes_(clothes), size_(size), texels_(RasterizeSurface(clothes.mesh, size, size)) {}

  [[nodiscard]] const std::vector<SurfaceTexel>& texels() const { return texels_; }
  [[nodiscard]] ClothPlace At(const SurfaceTexel& texel) const {
    const int panel = clothes_.vertex_panels[clothes_.mesh.indices[3 * texel.triangle]];
    const vec2 uv = (vec2(texel.x, texel.y) + 0.5f) / static_cast<float>(size_);
    const PanelPlace& place = clothes_.panels[panel];
    return {panel, (uv - place.place) / place.scale, texel.position};
  }

 private:
  const Clothes& clothes_;
  int size_;
  std::vector<SurfaceTexel> texels_;
};

bool IsTrousers(int panel) { return panel == kTrousersLeft || panel == kTrousersRight; }
bool IsSleeve(int panel) { return panel == kSleeveLeft || panel == kSleeveRight; }
bool IsCollar(int panel) {
  return panel == kCollarStand || panel == kCollarLeaf || panel == kCollarLining;
}

// 1 on a line of width `width`, with soft edges.
float Line(float distance, float width) {
  return Smoothstep(width, 0.5f * width, std::abs(distance));
}

// Stitches along a seam: dashes of 3 mm.
float Stitches(float distance, float along) {
  return Line(distance, 0.0012f) * Smoothstep(-0.2f, 0.3f, std::sin(along * 2.0f * kPi / 0.0036f));
}

// The distance from the buttons of the placket. The first is below the collar.
float ButtonDistance(const ClothPlace& at) {
  if (at.panel != kShirtFront || at.p.z < 0.0f) return 1.0f;
  constexpr float kFirst = 1.405f;
  constexpr float kSpacing = 0.083f;
  const float nearest = std::round((kFirst - at.p.y) / kSpacing);
  if (nearest < 0.0f) return 1.0f;
  return glm::length(vec2(at.p.x, at.p.y - (kFirst - nearest * kSpacing)));
}

constexpr float kButton = 0.0056f;

// How far a point is inside the pocket on the left of the chest; negative outside.
float PocketInside(const ClothPlace& at) {
  if (at.panel != kShirtFront) return -1.0f;
  const vec2 d = glm::abs(vec2(at.p.x - 0.083f, at.p.y - 1.262f)) - vec2(0.052f, 0.060f);
  const float corner = (d.x + d.y + 0.018f) * 0.7f * (at.p.y < 1.262f ? 1.0f : 0.0f);
  return -std::max({d.x, d.y, corner > 0.0f ? corner : -1.0f});
}

// The depth of the groove along seams, [0, 1]. Raises `stitches` where a seam is stitched.
float SeamLines(const ClothPlace& at, float* stitches) {
  const vec3& p = at.p;
  const float x = std::abs(p.x);
  float groove = 0.0f;
  const auto seam = [&](float distance, float along, bool stitched) {
    if (std::abs(distance) > 0.02f) return;
    if (stitched) {
      *stitches = std::max(*stitches, Stitches(distance, along));
    } else {
      groove = std::max(groove, Line(distance, 0.0022f));
    }
  };
  if (at.panel == kShirtFront && p.z > 0.0f) {
    seam(x - 0.0165f, p.y, false);
    seam(x - 0.0125f, p.y, true);
    const float pocket = PocketInside(at);
    seam(pocket, p.x + p.y, false);
    seam(pocket - 0.004f, p.x + p.y, true);
  }
  if (at.panel == kShirtBack) {
    const float yoke = p.y - (1.372f + 0.25f * x * x);
    if (x < 0.16f) {
      seam(yoke, p.x, false);
      seam(yoke - 0.004f, p.x, true);
    }
  }
  if (IsSleeve(at.panel)) {
    seam(x - 0.6485f, p.z + p.y, false);
    seam(x - 0.6525f, p.z + p.y, true);
    seam(x - 0.705f, p.z + p.y, true);
  }
  if (IsTrousers(at.panel)) {
    seam(p.y - 0.083f, p.x + p.z, true);
    if (p.y < 0.98f) seam(p.z + 0.004f, p.y, p.y > 1.1f);  // outer and inner seam
    // Slanted pockets in front, the fly, and a welt behind.
    if (p.z > 0.0f && p.y > 0.84f) {
      const float mouth = (x - 0.118f) - 0.30f * (1.0f - p.y);
      if (p.y > 0.855f) seam(mouth, p.y, false);
      if (p.y > 0.855f) seam(mouth + 0.006f, p.y, true);
      const float fly = p.x > 0.0f ? p.x - 0.032f * Smoothstep(0.845f, 0.90f, p.y) : 1.0f;
      seam(fly, p.y, true);
    } else if (p.z < 0.0f && std::abs(x - 0.088f) < 0.062f) {
      seam(p.y - 0.955f, p.x, false);
      seam(p.y - 0.949f, p.x, true);
    }
  }
  return groove;
}

// Permanent creases: soft, irregular ridges along lines of constant `across`, `spacing` apart.
float Gathers(float across, float along, float spacing) {
  return SignedNoise({across / spacing, along / (6.0f * spacing), 3.0f}) +
         0.5f * SignedNoise({across / spacing * 2.1f, along / (4.0f * spacing), 8.0f});
}

float KeptCreases(const ClothPlace& at) {
  const vec3& p = at.p;
  if (at.panel == kShirtFront || at.panel == kShirtBack) {
    const float round = std::atan2(p.x, p.z) * 0.15f;
    const float near = Bump(std::max(p.y - 1.05f, 0.0f), 0.055f);
    const float drape = 0.35f * Bump(p.y - 1.17f, 0.12f);
    // Slanted, from the armpits toward the waist.
    return 0.0017f * (near + drape) * Gathers(round, p.y + 0.35f * std::abs(p.x), 0.016f);
  }
  if (IsSleeve(at.panel)) {
    const float x = std::abs(p.x);
    const float round = std::atan2(p.y - 1.425f, p.z + 0.015f) * 0.05f;
    const float cuff = x < 0.6485f ? Bump(x - 0.6485f, 0.035f) : 0.0f;
    const float elbow = Bump(x - 0.455f, 0.085f);
    return 0.0011f * cuff * Gathers(round, x, 0.009f) +
           0.0012f * elbow * Gathers(x + 0.12f * std::abs(round), round, 0.021f);
  }
  if (IsTrousers(at.panel)) {
    const float knee = Bump(p.y - 0.485f, 0.09f) * Smoothstep(0.03f, -0.03f, p.z);
    const float hem = Bump(p.y - 0.105f, 0.07f);
    const float round = std::atan2(std::abs(p.x) - 0.097f, p.z) * 0.06f;
    const float crotch = Bump(p.y - 0.80f, 0.07f) * Smoothstep(0.10f, 0.02f, std::abs(p.x));
    return 0.0014f * knee * Gathers(p.y + 0.1f * round, round, 0.024f) +
           0.0016f * hem * Gathers(p.y + 0.25f * std::abs(round), round, 0.028f) +
           0.0013f * crotch * Gathers(p.y - 0.7f * std::abs(p.x), p.x, 0.022f);
  }
  return 0.0f;
}

// Trousers break over the shoe, in slanted folds that never leave.
float Break(const ClothPlace& at) {
  const float round = std::atan2(std::abs(at.p.x) - 0.097f, at.p.z) * 0.06f;
  return 0.0030f * Bump(at.p.y - 0.13f, 0.05f) *
         Gathers(at.p.y + 0.45f * std::abs(round), round, 0.042f);
}

// Threads: warp and weft of the shirt, diagonal twill of the trousers. About [-1, 1].
float Weave(const ClothPlace& at) {
  if (IsTrousers(at.panel)) {
    return std::sin((at.cut.x + at.cut.y) * 2.0f * kPi / 0.0042f) *
           (0.7f + 0.3f * SignedNoise(vec3(at.cut * 140.0f, 1.0f)));
  }
  return 0.5f * SignedNoise({at.cut.x * 420.0f, at.cut.y * 45.0f, 2.0f}) +
         0.5f * SignedNoise({at.cut.x * 45.0f, at.cut.y * 420.0f, 5.0f});
}

float Height(const ClothPlace& at) {  // metres
  float stitches = 0.0f;
  const float groove = SeamLines(at, &stitches);
  float height = KeptCreases(at) - 0.0007f * groove - 0.00035f * stitches;
  height += (IsTrousers(at.panel) ? 0.00010f : 0.00007f) * Weave(at);
  if (at.panel == kShirtFront && at.p.z > 0.0f) {
    height += 0.0008f * Smoothstep(0.018f, 0.0155f, std::abs(at.p.x));
    height += 0.0006f * Smoothstep(0.0f, 0.002f, PocketInside(at));
    const float button = ButtonDistance(at);
    height += 0.0018f * Smoothstep(kButton + 0.0006f, kButton - 0.001f, button) -
              0.0007f * Smoothstep(0.0036f, 0.0026f, button);
  }
  if (IsTrousers(at.panel)) {  // pressed
    height += Break(at);
    const float middle = std::abs(std::abs(at.p.x) - 0.096f);
    height += 0.0012f * Bump(middle, 0.006f) * Smoothstep(0.02f, 0.045f, std::abs(at.p.z)) *
              Smoothstep(0.86f, 0.72f, at.p.y);
  }
  return height;
}

}  // namespace

character::Picture PaintClothColour(const Clothes& clothes, const BodyParameters& body, int size) {
  const ClothAtlas atlas(clothes, size);
  return FillPicture("cloth_colour", atlas.texels(), size, 3, [&](const SurfaceTexel& texel) {
    const ClothPlace at = atlas.At(texel);
    const bool trousers = IsTrousers(at.panel);
    vec3 colour = trousers ? body.trousers : body.shirt;
    const float worn = FractalNoise(at.p * 9.0f);
    colour *= 1.0f + (trousers ? 0.06f : 0.03f) * Weave(at) + (trousers ? 0.05f : 0.025f) * worn;
    // Paler at pressed edges and bends, darker in the permanent creases.
    colour *= 1.0f + 45.0f * KeptCreases(at);
    float stitches = 0.0f;
    const float groove = SeamLines(at, &stitches);
    colour *= 1.0f - 0.30f * groove;
    colour = glm::mix(colour, colour * (trousers ? 1.25f : 1.08f), 0.7f * stitches);
    if (IsCollar(at.panel)) colour *= 1.015f;
    const float button = ButtonDistance(at);
    colour *= 1.0f - 0.35f * Smoothstep(kButton + 0.0028f, kButton, button);
    const vec3 pearl = vec3(0.86f, 0.84f, 0.80f) * (1.0f - 0.35f * Line(button - 0.0034f, 0.001f));
    colour = glm::mix(colour, pearl, Smoothstep(kButton + 0.0004f, kButton - 0.0004f, button));
    return glm::vec4(colour, 1.0f);
  });
}

character::Picture PaintClothNormals(const Clothes& clothes, int size) {
  const ClothAtlas atlas(clothes, size);
  std::vector<vec2> slopes;
  slopes.reserve(atlas.texels().size());
  constexpr float kStep = 0.0006f;
  for (const SurfaceTexel& texel : atlas.texels()) {
    const ClothPlace at = atlas.At(texel);
    const auto beside = [&](const vec2& by) {
      const vec3 p = at.p + (texel.tangent * by.x + texel.bitangent * by.y) * kStep;
      return Height({at.panel, at.cut + vec2(by.x, -by.y) * kStep, p});
    };
    slopes.emplace_back((beside({-1, 0}) - beside({1, 0})) / (2.0f * kStep),
                        (beside({0, -1}) - beside({0, 1})) / (2.0f * kStep));
  }
  character::Picture picture = EncodeNormals(atlas.texels(), slopes, size, size, kNormalBits);
  picture.name = "cloth_normal";
  return picture;
}

character::Picture PaintClothRoughness(const Clothes& clothes, int size) {
  const ClothAtlas atlas(clothes, size);
  return FillPicture("cloth_roughness", atlas.texels(), size, 3, [&](const SurfaceTexel& texel) {
    const ClothPlace at = atlas.At(texel);
    const float cloth = (IsTrousers(at.panel) ? 0.88f : 0.80f) + 0.04f * Weave(at);
    const float button = Smoothstep(kButton + 0.0004f, kButton - 0.0004f, ButtonDistance(at));
    return glm::vec4(0.0f, glm::mix(cloth, 0.30f, button), 0.0f, 1.0f);
  });
}

}  // namespace furrow::authoring

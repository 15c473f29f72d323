// SPDX-License-Identifier: Apache-2.0
#include "authoring/bake/cloth/cloth_effect.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "authoring/bake/cloth/cloth_strain.h"
#include "authoring/bake/cloth/sheet_math.h"
#include "authoring/bake/surface/posed_surface.h"
#include "authoring/paint/noise.h"
#include "base/scalar.h"

namespace furrow::authoring {
namespace {

using glm::mat3;
using glm::vec3;

// How far a bend pushes cloth along the body, how far a pull spreads, and how far around a limb
// cloth slips to where it is pulled, metres.
constexpr ClothSlip kSlip{.pressed = 0.075f, .pulled = 0.025f, .fed = 0.09f};
// How much more length a bend takes from cloth than from the skinned surface, which is rounder.
constexpr float kBend = 2.6f;
// The share of the ease that hanging cloth has across gravity, and along it.
constexpr float kHanging = 0.9f;
constexpr float kHangingAlong = 0.1f;
// Cloth that is cut tighter than this also stacks less.
constexpr float kUsualEase = 0.15f;
// Strain of cloth that just hangs, and of cloth that a pose deforms.
constexpr float kStill = 0.02f;
constexpr float kMoved = 0.12f;
// How much wider apart and how high drag lines are, relative to folds that are pressed.
constexpr float kDragWidth = 1.35f;
constexpr float kDragHeight = 0.68f;
// Likewise of folds in cloth that feeds a pull nearby: it slides there little by little.
constexpr float kFedWidth = 0.8f;
constexpr float kFedHeight = 0.6f;
// The size of loose and tight places, in wavelengths, and how much longer they are along gravity.
constexpr float kPlace = 2.5f;
constexpr float kLong = 0.7f;  // a share of the way along gravity that does not count

// The vertices of `mesh` on a posed surface.
std::vector<vec3> PlacesOn(const FineMesh& mesh, std::span<const PosedVertex> surface) {
  std::vector<vec3> welded, places;
  for (const PosedVertex& vertex : surface) welded.push_back(vertex.position);
  for (const FineMesh::Vertex& vertex : mesh.vertices()) {
    places.push_back(vertex.Interpolate(std::span<const vec3>(welded)));
  }
  return places;
}

// The direction of gravity at a vertex of a posed mesh, at rest.
vec3 DownAt(const FineMesh::Vertex& vertex, std::span<const PosedVertex> posed) {
  constexpr vec3 kDown(0.0f, -1.0f, 0.0f);
  vec3 down(0.0f);
  for (int k = 0; k < 3; ++k) {
    const PosedVertex& corner = posed[vertex.corners[static_cast<std::size_t>(k)]];
    down += vertex.shares[k] * (glm::transpose(corner.turn) * kDown);
  }
  return UnitOr(down, kDown);
}

// How much ease a place has, relative to the mean. Seams, wear and the body below make cloth
// uneven; hanging cloth falls in long folds, so loose places are longer along gravity than wide.
float LoosenessAt(const vec3& p, const vec3& down, const WornCloth& cloth, float least) {
  const vec3 place = (p - kLong * glm::dot(p, down) * down) / (kPlace * cloth.fabric.wavelength);
  const vec3 shift(34.0f, 0.37f * static_cast<float>(cloth.seed % 997), 5.0f);
  return std::lerp(least, 2.0f - least, Smoothstep(-0.3f, 0.6f, SignedNoise(place + shift)));
}

}  // namespace

ClothEffect MeasureClothEffect(const FineMesh& mesh, const WornCloth& cloth,
                               std::span<const glm::mat4> bent,
                               std::span<const float> shape_weights) {
  const Surface& surface = mesh.surface();
  const std::vector<vec3> morphed =
      shape_weights.empty() ? std::vector<vec3>() : surface.Morphed(shape_weights);
  const std::vector<PosedVertex> posed =
      PoseSurface(surface, bent, morphed.empty() ? surface.positions() : std::span(morphed));
  const std::vector<vec3> cut =
      PlacesOn(mesh, PoseSurface(surface, cloth.cut, surface.positions()));
  ClothSlip slip = kSlip;
  slip.feeds = cloth.feeds;
  slip.stretches = cloth.fabric.stretches;
  const ClothStrain strain = MeasureClothStrain(mesh, cut, PlacesOn(mesh, posed), cloth.room, slip);
  const std::vector<vec3> normals = NormalsOf(mesh);
  const std::size_t count = mesh.vertices().size();
  ClothEffect effect{std::vector<mat3>(count, mat3(0.0f)), std::vector<float>(count, 0.0f),
                     std::vector<float>(count, 1.0f), std::vector<float>(count, 1.0f)};
  for (std::size_t v = 0; v < count; ++v) {
    if (!(cloth.room[v] > 0.0f)) continue;
    const vec3 down = DownAt(mesh.vertices()[v], posed);
    const vec3 fall = down - normals[v] * glm::dot(down, normals[v]);
    const vec3 along = UnitOr(fall, vec3(0.0f)), level = glm::cross(normals[v], along);
    const ClothEase& ease = cloth.eases[v];
    const float pulled = TraceOf(strain.pulled[v]), fed = strain.fed[v];
    // Cloth that lies on the body does not hang, and taut cloth has no ease left.
    const float taut = 0.8f * Smoothstep(0.03f, 0.15f, pulled);
    const float uneven = (1.0f - taut) * LoosenessAt(mesh.positions()[v], down, cloth, ease.least) *
                         Smoothstep(0.2f, 0.7f, glm::length(fall));
    const float loose = uneven * cloth.ease * ease.looser;
    const float stacked = uneven * ease.stacks * std::min(cloth.ease / kUsualEase, 1.0f);
    effect.slack[v] = kBend * strain.lost[v] - strain.pulled[v] +
                      kHanging * loose * glm::outerProduct(level, level) +
                      (kHangingAlong * loose + stacked) * glm::outerProduct(along, along);
    const float lost = TraceOf(strain.lost[v]) + stacked;
    const float moved = Smoothstep(kStill, kMoved, lost + pulled);
    const float dragged = Smoothstep(0.04f, 0.2f, pulled - 0.5f * lost);
    // Cloth that feeds a pull has no large forms: those are lumps below a kneecap.
    effect.pressed[v] = moved * Smoothstep(0.15f, 0.8f, (lost - fed) / (pulled + kStill));
    const float feeding = fed / (lost + kStill);
    effect.height[v] = std::lerp(1.0f, kDragHeight, dragged) * std::lerp(1.0f, kFedHeight, feeding);
    effect.width[v] = std::lerp(cloth.fabric.hanging, std::lerp(1.0f, kDragWidth, dragged), moved) *
                      std::lerp(1.0f, kFedWidth, feeding);
  }
  return effect;
}

}  // namespace furrow::authoring

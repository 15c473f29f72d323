// SPDX-License-Identifier: Apache-2.0
#include "authoring/generator/textures/head_brows.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "authoring/generator/mesh/mesh_tools.h"
#include "authoring/generator/textures/skin_regions.h"
#include "authoring/paint/noise.h"
#include "base/scalar.h"

namespace furrow::authoring {
namespace {

using glm::vec2;
using glm::vec3;

// A hair of a brow, seen from the front: from `root` to `tip`, curved by `bend`.
struct BrowHair {
  vec2 root;
  vec2 tip;
  vec2 bend;
  float width;
};

constexpr Knot kLine[] = {
    {0.95f, 1.72f}, {2.0f, 1.92f}, {3.3f, 2.14f}, {4.2f, 2.06f}, {5.3f, 1.55f}};
constexpr Knot kHeight[] = {
    {0.9f, 0.26f}, {1.5f, 0.36f}, {2.6f, 0.32f}, {4.0f, 0.20f}, {5.3f, 0.06f}};

// Hairs stand up at the inner end and lie outward farther along. Lower hairs point up, upper ones
// down.
std::vector<BrowHair> MakeBrow(float side, const FaceParameters& face) {
  std::vector<BrowHair> hairs;
  const int seed = side > 0.0f ? 11 : 47;
  const int count = static_cast<int>(170.0f + 50.0f * face.sex - 40.0f * AgeShare(face));
  const float thick = 0.85f + 0.2f * face.sex;
  for (int i = 0; i < count; ++i) {
    const float t = (static_cast<float>(i) + RandomAt(i, seed, 1)) / static_cast<float>(count);
    const float x = 0.95f + 4.15f * std::pow(t, 0.92f);
    const float row = 2.0f * RandomAt(i, seed, 2) - 1.0f;
    const float y = Interpolate(kLine, x) + row * thick * Interpolate(kHeight, x);
    const float along = Smoothstep(0.9f, 2.0f, x);
    const float rise = (1.0f - along) * 1.15f + along * (0.30f - 0.42f * row) -
                       0.35f * Smoothstep(3.6f, 5.0f, x) + 0.3f * (RandomAt(i, seed, 3) - 0.5f);
    const vec2 direction(std::cos(rise), std::sin(rise));
    const float length = (0.42f + 0.3f * RandomAt(i, seed, 4)) * (1.0f - 0.35f * t);
    const vec2 across(-direction.y, direction.x);
    hairs.push_back({{x, y},
                     vec2(x, y) + direction * length,
                     across * (-0.12f * length * (0.4f + RandomAt(i, seed, 5))),
                     0.020f + 0.012f * RandomAt(i, seed, 6)});
  }
  return hairs;
}

// How much a hair darkens a point. The hair tapers to its tip.
float Cover(const BrowHair& hair, const vec2& p) {
  const vec2 line = hair.tip - hair.root;
  const float t = std::clamp(glm::dot(p - hair.root, line) / glm::dot(line, line), 0.0f, 1.0f);
  const vec2 on = hair.root + t * line + 4.0f * t * (1.0f - t) * hair.bend;
  const float width = hair.width * (1.1f - 0.7f * t);
  return Smoothstep(width + 0.02f, 0.4f * width, glm::distance(p, on)) * (1.0f - 0.35f * t);
}

}  // namespace

float BrowShare(const vec3& p, const FaceParameters& face) {
  const vec3 q = OnLeftSide(p);
  if (q.x < 0.7f || q.x > 6.0f || q.z < 3.0f || q.y < 0.8f || q.y > 3.2f) return 0.0f;
  // The painter calls this for each texel, so the hairs of the last face are cached.
  thread_local float of_sex = 9.0f, of_age = 0.0f;
  thread_local std::vector<BrowHair> brows[2];
  if (of_sex != face.sex || of_age != face.age) {
    brows[0] = MakeBrow(1.0f, face);
    brows[1] = MakeBrow(-1.0f, face);
    of_sex = face.sex;
    of_age = face.age;
  }
  const vec2 at(q.x, q.y);
  float bare = 1.0f;
  for (const BrowHair& hair : brows[p.x > 0.0f ? 0 : 1]) {
    if (std::abs(hair.root.x - at.x) > 0.9f) continue;
    bare *= 1.0f - 0.75f * Cover(hair, at);
  }
  const float d = (at.y - 0.05f - Interpolate(kLine, at.x)) / (1.25f * Interpolate(kHeight, at.x));
  const float shade = 0.30f * Smoothstep(1.0f, 0.2f, std::abs(d)) * Smoothstep(0.8f, 1.5f, at.x) *
                      Smoothstep(5.6f, 4.6f, at.x);
  return 1.0f - bare * (1.0f - shade);
}

}  // namespace furrow::authoring
